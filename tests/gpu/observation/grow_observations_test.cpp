#include "passes/observation/grow_observations.h"

#include "engine/graph/enlargement.h"
#include "passes/state/reflectance_state.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/observed_scene.h"

namespace patina::grow_observations_test {
namespace {

using namespace observed_scene;

class GrowObservationsTest : public GpuTest {
  protected:
    ObservationRig rig(uint32_t blocks, uint32_t records, uint64_t chunk_bytes = uint64_t{1} << 27) {
        ObservationMapSettings map;
        map.capacity_blocks = blocks;
        map.capacity_records = records;
        map.max_chunk_bytes = chunk_bytes;
        ObservationSettings settings;
        settings.stride_px = 1;
        return {device(), runner(), map, settings};
    }

    void grow(ObservationRig& rig, uint32_t blocks, uint32_t records) {
        ObservationMap& map = rig.map();
        const uint32_t blocks_before = map.capacity_blocks(), records_before = map.capacity_records();
        graph::Enlargement enlargement(device());
        if (blocks > blocks_before) map.enlarge_blocks(enlargement, blocks);
        if (records > records_before) map.enlarge_records(enlargement, records);
        enlargement.allocate();
        graph::FrameGraph frame = runner().begin();
        enlargement.commit(frame);
        ObservationMapIds ids = map.import(frame);
        if (blocks > blocks_before) add_grow_observed_blocks(frame, map, ids, blocks_before);
        if (records > records_before) add_grow_records(frame, map, ids, records_before);
        ObservationMap::keep(frame, ids);
        enlargement.keep(frame);
        run(std::move(frame));
        enlargement.accept();
    }

    void fuse_both(ObservationRig& rig) {
        rig.fuse(left_);
        rig.fuse(right_);
    }

    const reference::DistanceField wall_ = reference::half_space({0, 0, -1}, -1.003);  // z = 1.003, free before it
    const RigFrame left_ = frame_of(wall_, reference::look_at({-0.9, 0, 0.5}, {-0.9, 0, 1}));
    const RigFrame right_ = frame_of(wall_, RigidTransform(1.0));
};

TEST_F(GrowObservationsTest, RecordsStayAndNewOnesFindRoomWithinAChunkAndBeyond) {
    ObservationRig large = rig(4096, 16384);
    fuse_both(large);
    large.collect(left_);
    const ObservationContent expected_left = large.content();
    large.collect(right_);
    const ObservationContent expected = large.content();
    ASSERT_GT(expected.size(), 1500u);
    for (const uint64_t chunk_bytes : {uint64_t{1} << 27, uint64_t{1} << 17}) {  // of 1024 records
        ObservationRig small = rig(250, 1000, chunk_bytes);
        fuse_both(small);
        small.collect(left_);
        ASSERT_EQ(small.block_counters().refused_blocks + small.record_counters().refused_blocks, 0u);
        grow(small, 2000, 3000);
        EXPECT_EQ(small.content(), expected_left);
        small.collect(right_);
        EXPECT_EQ(small.block_counters().refused_blocks + small.record_counters().refused_blocks, 0u);
        EXPECT_EQ(small.content(), expected);
    }
}

TEST_F(GrowObservationsTest, RecordsStayWhenTheTableGrows) {
    ObservationRig small = rig(32768, 16384), large = rig(40000, 16384);
    ASSERT_LT(small.map().table_slots(), large.map().table_slots());
    for (ObservationRig* rig : {&small, &large}) {
        fuse_both(*rig);
        rig->collect(left_);
    }
    grow(small, 40000, 16384);
    EXPECT_EQ(small.map().table_slots(), large.map().table_slots());
    EXPECT_EQ(small.content(), large.content());
    for (ObservationRig* rig : {&small, &large}) rig->collect(right_);
    EXPECT_EQ(small.content(), large.content());
}

TEST_F(GrowObservationsTest, WhatWasRefusedComesAgain) {
    for (const bool blocks_run_out : {false, true}) {
        SCOPED_TRACE(blocks_run_out ? "blocks" : "records");
        ObservationRig rig = blocks_run_out ? this->rig(250, 16384) : this->rig(4096, 1000);
        fuse_both(rig);
        rig.collect(left_);
        rig.collect(right_);
        const auto refused = [&] {
            return (blocks_run_out ? rig.block_counters() : rig.record_counters()).refused_blocks;
        };
        const uint32_t before = refused();
        ASSERT_GT(before, 100u);
        grow(rig, 4096, 16384);
        rig.collect(right_);
        EXPECT_EQ(refused(), before) << "nothing more was refused";
        ObservationRig large = this->rig(4096, 16384);
        fuse_both(large);
        large.collect(left_);
        large.collect(right_);
        EXPECT_EQ(rig.content().size(), large.content().size());
    }
}

TEST_F(GrowObservationsTest, NothingIsUpToDateOfNewRecords) {
    ObservationRig rig = this->rig(64, 100);
    ReflectanceState state(device(), rig.map());
    graph::FrameGraph first = runner().begin();
    state.reset(first);
    run(std::move(first));
    const std::vector<uint32_t> ones(100 * sizeof(gpu::RecordStatus) / sizeof(uint32_t), 1);
    graph::FrameGraph second = runner().begin();
    second.keep(second.upload_bytes(state.import(second).status, 0, std::as_bytes(std::span(ones)), true));
    run(std::move(second));
    graph::Enlargement enlargement(device());
    state.enlarge(enlargement, 150);
    enlargement.allocate();
    graph::FrameGraph frame = runner().begin();
    enlargement.commit(frame);
    const graph::Readback status = frame.read_back(state.import(frame).status);
    enlargement.keep(frame);
    run(std::move(frame));
    enlargement.accept();
    std::vector<uint32_t> expected = ones;
    expected.resize(150 * sizeof(gpu::RecordStatus) / sizeof(uint32_t), 0);
    EXPECT_EQ(status.as<uint32_t>(), expected);
}

}  // namespace
}  // namespace patina::grow_observations_test
