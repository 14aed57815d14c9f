#include "passes/observation/reclaim_records.h"

#include <algorithm>
#include <numeric>

#include "engine/graph/enlargement.h"
#include "passes/observation/grow_observations.h"
#include "reconstruction/streaming/stream_region.h"
#include "shared/fusion/remove_empty_blocks.h"
#include "shared/observation/reclaim.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/observation/observed_scene.h"
#include "tests/reference/observation/reclaim_records.h"

namespace patina::reclaim_records_test {
namespace {

using namespace observed_scene;
using Voxel = std::array<int, 3>;

const reference::DistanceField kWall = reference::half_space({0, 0, -1}, -1.203);  // z = 1.203, free before it

/// The wall with a box before it.
reference::DistanceField wall_and_box(double x_m) {
    const reference::DistanceField box = reference::box({x_m, 0, 0.95}, {0.08, 0.08, 0.08});
    return [box](glm::dvec3 point) { return std::min(kWall(point), box(point)); };
}

RigFrame wall_frame() { return frame_of(kWall, RigidTransform(1.0)); }
RigFrame box_frame(double x_m) { return frame_of(wall_and_box(x_m), RigidTransform(1.0)); }

std::vector<Voxel> voxels_of(const ObservationContent& content) {
    std::vector<Voxel> voxels;
    for (const auto& [at, record] : content) voxels.push_back(at);
    return voxels;
}

/// Every id of a pool is either in use or free, once.
void expect_all_once(const ObservationRig::PoolIds& pool, uint32_t capacity) {
    std::vector<uint32_t> ids = pool.used, expected(capacity);
    ids.insert(ids.end(), pool.free.begin(), pool.free.end());
    std::sort(ids.begin(), ids.end());
    std::iota(expected.begin(), expected.end(), 0u);
    EXPECT_EQ(ids, expected);
}

class ReclaimRecordsTest : public GpuTest {
  protected:
    ObservationRig rig(float voxel_m = 0.02f, uint32_t blocks = 4096, uint32_t records = 16384,
                       uint64_t voxel_chunk_bytes = uint64_t{1} << 30) {
        ObservationMapSettings map;
        map.voxel_m = voxel_m;
        map.capacity_blocks = blocks;
        map.capacity_records = records;
        ObservationSettings settings;
        settings.stride_px = 1;
        VoxelMapSettings voxels;
        voxels.max_chunk_bytes = voxel_chunk_bytes;
        voxels.capacity_blocks = 8192;
        return {device(), runner(), map, settings, {}, voxels};
    }

    /// Fuses a frame until what was there before is gone.
    static void replace(ObservationRig& rig, const RigFrame& frame) {
        rig.fuse(frame, 16);
        rig.fusion().remove_empty_blocks(frame.camera, frame.world_from_camera);
    }

    static void reclaim_all(ObservationRig& rig, float near = gpu::kSurfaceTruncation) {
        for (uint32_t turn = 0; turn < gpu::kReclaimParts; ++turn) rig.reclaim(turn, near);
    }

    static std::set<Voxel> expected(ObservationRig& rig, const ObservationContent& before,
                                    float near = gpu::kSurfaceTruncation) {
        const double near_m = double{near} * double{rig.fusion().settings().truncation_m};
        return reference::with_surface(rig.fusion().volume(), voxels_of(before), double{rig.map().settings().voxel_m},
                                       near_m);
    }

    void grow(ObservationRig& rig, uint32_t blocks, uint32_t records) {
        ObservationMap& map = rig.map();
        const uint32_t blocks_before = map.capacity_blocks(), records_before = map.capacity_records();
        graph::Enlargement enlargement(device());
        map.enlarge_blocks(enlargement, blocks);
        map.enlarge_records(enlargement, records);
        enlargement.allocate();
        graph::FrameGraph frame = runner().begin();
        enlargement.commit(frame);
        ObservationMapIds ids = map.import(frame);
        add_grow_observed_blocks(frame, map, ids, blocks_before);
        add_grow_records(frame, map, ids, records_before);
        ObservationMap::keep(frame, ids);
        enlargement.keep(frame);
        run(std::move(frame));
        enlargement.accept();
    }

    static void expect_consistent(ObservationRig& rig) {
        expect_all_once(rig.block_ids(), rig.map().capacity_blocks());
        expect_all_once(rig.record_ids(), rig.map().capacity_records());
    }
};

TEST_F(ReclaimRecordsTest, OutsideTheRegionNothingGoes) {
    ObservationRig rig = this->rig();
    rig.fuse(box_frame(0));
    rig.collect(box_frame(0));
    const ObservationContent before = rig.content();
    replace(rig, wall_frame());
    const std::set<Voxel> kept = expected(rig, before);
    // A ball through the box's middle: what went lies on both of its sides.
    const StreamRegion region = StreamRegion::ball({0.3, 0, 0.95}, 0.3);
    for (uint32_t turn = 0; turn < gpu::kReclaimParts; ++turn) rig.reclaim(turn, gpu::kSurfaceTruncation, region);
    const ObservationContent after = rig.content();
    uint32_t gone = 0, outside = 0;
    for (const auto& [at, record] : before) {
        if (kept.contains(at)) continue;
        const glm::ivec3 block = glm::ivec3(at[0] >> 1, at[1] >> 1, at[2] >> 1);
        const bool inside = region.holds(rig.fusion().map().grid(), block);
        EXPECT_EQ(after.contains(at), !inside);
        ++(inside ? gone : outside);
    }
    EXPECT_GT(gone, 20u);
    EXPECT_GT(outside, 20u);
    expect_consistent(rig);
}

TEST_F(ReclaimRecordsTest, OnlyRecordsWithoutSurfaceGoAndTheOthersStayAsTheyAre) {
    struct Case {
        float voxel_m;
        uint64_t chunk_bytes;
    };
    for (const auto& [voxel_m, chunk_bytes] :
         {Case{0.02f, uint64_t{1} << 30}, Case{0.01f, uint64_t{1} << 30}, Case{0.02f, uint64_t{1} << 22}}) {
        SCOPED_TRACE(text("voxels of ", voxel_m, " m, chunks of ", chunk_bytes, " bytes"));
        ObservationRig rig = this->rig(voxel_m, 4096, 16384, chunk_bytes);
        rig.fuse(box_frame(0));
        rig.collect(box_frame(0));
        const ObservationContent before = rig.content();
        reclaim_all(rig);
        EXPECT_EQ(rig.content(), before) << "nothing went";

        replace(rig, wall_frame());
        const std::set<Voxel> kept = expected(rig, before);
        ASSERT_GT(before.size(), kept.size() + 40);
        ASSERT_GT(kept.size(), 500u);
        reclaim_all(rig);
        const ObservationContent after = rig.content();
        ASSERT_EQ(after.size(), kept.size());
        for (const auto& [at, record] : after) {
            ASSERT_TRUE(kept.contains(at));
            EXPECT_EQ(record, before.at(at));
        }
        EXPECT_EQ(rig.record_counters().deleted_blocks, before.size() - kept.size());
        EXPECT_GT(rig.block_counters().deleted_blocks, 0u);
        expect_consistent(rig);

        std::vector<glm::ivec4> asked;
        for (const Voxel& at : voxels_of(before)) asked.emplace_back(at[0], at[1], at[2], 0);
        const std::vector<gpu::VoxelRecord> found = rig.find(asked);
        for (size_t i = 0; i < asked.size(); ++i)
            EXPECT_EQ(found[i].block_key != gpu::kEmptyKey, kept.contains({asked[i].x, asked[i].y, asked[i].z}));
    }
}

TEST_F(ReclaimRecordsTest, EveryVoxelOfAnObservedOneCounts) {
    // Of a plane that leans, so few voxels are this near that most observed ones hold one or none, each at another
    // place.
    constexpr float kNear = 0.0371f;
    const RigFrame leaning = frame_of(reference::half_space({0.3, 0.2, -0.93}, -1.1), RigidTransform(1.0));
    for (const float voxel_m : {0.02f, 0.01f}) {
        ObservationRig rig = this->rig(voxel_m);
        rig.fuse(leaning);
        rig.collect(leaning);
        const ObservationContent before = rig.content();
        const std::set<Voxel> kept = expected(rig, before, kNear);
        ASSERT_GT(kept.size(), 200u) << voxel_m;
        ASSERT_GT(before.size(), kept.size() + 200) << voxel_m;
        reclaim_all(rig, kNear);
        std::set<Voxel> left;
        for (const auto& [at, record] : rig.content()) left.insert(at);
        EXPECT_EQ(left, kept) << voxel_m;
    }
}

TEST_F(ReclaimRecordsTest, EachPartHasItsTurn) {
    ObservationRig rig = this->rig();
    rig.fuse(box_frame(0));
    rig.collect(box_frame(0));
    const size_t before = rig.content().size();
    replace(rig, wall_frame());
    std::vector<size_t> gone;
    for (uint32_t turn = 0; turn < gpu::kReclaimParts; ++turn) {
        const size_t had = rig.content().size();
        rig.reclaim(turn + gpu::kReclaimParts);
        const ObservationContent after = rig.content();
        gone.push_back(had - after.size());
        rig.reclaim(turn);
        EXPECT_EQ(rig.content(), after) << "the same part again";
    }
    for (const size_t count : gone) EXPECT_GT(count, 0u);
    EXPECT_EQ(std::accumulate(gone.begin(), gone.end(), rig.content().size()), before);
}

TEST_F(ReclaimRecordsTest, WhatWasGivenBackIsTakenAgainAndBeginsEmpty) {
    ObservationRig with = rig(), without = rig();
    for (ObservationRig* rig : {&with, &without}) {
        rig->fuse(box_frame(0));
        rig->collect(box_frame(0));
        replace(*rig, wall_frame());
    }
    reclaim_all(with);
    for (ObservationRig* rig : {&with, &without}) rig->collect(wall_frame());
    // Behind the box there are new records, in places that its own had.
    const gpu::MapCounters counters = with.record_counters();
    EXPECT_GT(counters.capacity - counters.free_blocks + counters.deleted_blocks, counters.high_water);
    const ObservationContent got = with.content(), all = without.content();
    EXPECT_LT(got.size(), all.size());
    for (const auto& [at, record] : got) EXPECT_EQ(record, all.at(at));
    expect_consistent(with);
}

TEST_F(ReclaimRecordsTest, ThingsThatAreCarriedRoundLeaveNothingBehind) {
    ObservationRig moved = rig(), fresh = rig();
    double x_m = -0.3;
    for (uint32_t turn = 0; turn < 3 * gpu::kReclaimParts; ++turn, x_m += 0.05) {
        replace(moved, box_frame(x_m));
        moved.reclaim(turn);
        moved.collect(box_frame(x_m));
    }
    x_m -= 0.05;
    reclaim_all(moved);
    replace(fresh, box_frame(x_m));
    fresh.collect(box_frame(x_m));
    // The box hides a part of the wall that was seen before.
    const gpu::MapCounters used = moved.record_counters(), at_end = fresh.record_counters();
    EXPECT_LT(used.capacity - used.free_blocks, 1.2 * (at_end.capacity - at_end.free_blocks));
    EXPECT_GT(used.deleted_blocks, 150u);
    const ObservationContent content = moved.content();
    EXPECT_EQ(expected(moved, content).size(), content.size()) << "all that is left holds surface";
    expect_consistent(moved);
}

TEST_F(ReclaimRecordsTest, WhatWasRefusedComesAgain) {
    for (const bool blocks_run_out : {false, true}) {
        SCOPED_TRACE(blocks_run_out ? "blocks" : "records");
        ObservationRig rig = blocks_run_out ? this->rig(0.02f, 700, 16384) : this->rig(0.02f, 4096, 2000);
        ObservationRig large = this->rig();
        for (ObservationRig* each : {&rig, &large}) {
            each->fuse(box_frame(0));
            each->collect(box_frame(0));
            replace(*each, wall_frame());
        }
        const auto refused = [&] {
            return (blocks_run_out ? rig.block_counters() : rig.record_counters()).refused_blocks;
        };
        ASSERT_GT(refused(), 0u);
        reclaim_all(rig);
        reclaim_all(large);
        const size_t before = rig.content().size();
        rig.collect(wall_frame());
        large.collect(wall_frame());
        EXPECT_GT(rig.content().size(), before);
        EXPECT_LE(rig.content().size(), large.content().size());
        expect_consistent(rig);
    }
}

TEST_F(ReclaimRecordsTest, PoolsGrowAfterRecordsWereGivenBack) {
    ObservationRig small = rig(0.02f, 2500, 6000), large = rig(0.02f, 4096, 16384);
    for (ObservationRig* rig : {&small, &large}) {
        rig->fuse(box_frame(0));
        rig->collect(box_frame(0));
        ASSERT_EQ(rig->block_counters().refused_blocks + rig->record_counters().refused_blocks, 0u);
        replace(*rig, wall_frame());
        reclaim_all(*rig);
        ASSERT_GT(rig->record_counters().deleted_blocks, 0u);
    }
    grow(small, 4096, 16384);
    expect_consistent(small);
    EXPECT_EQ(small.content(), large.content());
    for (ObservationRig* rig : {&small, &large}) {
        rig->collect(wall_frame());
        rig->fuse(box_frame(0.3));
        rig->collect(box_frame(0.3));
    }
    EXPECT_EQ(small.content(), large.content());
    expect_consistent(small);
}

TEST_F(ReclaimRecordsTest, NothingIsUpToDateOfWhatWasGivenBack) {
    ObservationRig rig = this->rig();
    ReflectanceState state(device(), rig.map());
    rig.fuse(box_frame(0));
    rig.collect(box_frame(0));
    const size_t before = rig.content().size();
    graph::FrameGraph first = runner().begin();
    state.reset(first);
    run(std::move(first));
    graph::FrameGraph second = runner().begin();
    second.keep(second.fill(state.import(second).status, 7));
    second.keep(second.fill(state.import(second).gathered, 7));
    run(std::move(second));
    replace(rig, wall_frame());

    graph::FrameGraph frame = runner().begin();
    ObservationMapIds ids = rig.map().import(frame);
    ReflectanceStateIds status = state.import(frame);
    const VoxelMapIds voxels = rig.fusion().map().import(frame);
    for (uint32_t turn = 0; turn < gpu::kReclaimParts; ++turn)
        add_reclaim_records(frame, rig.map(), ids, status, rig.fusion().map(), voxels, 0.019f, StreamRegion{}.gpu(),
                            turn);
    ObservationMap::keep(frame, ids);
    ReflectanceState::keep(frame, status);
    const graph::Readback read = frame.read_back(status.status), gathered_read = frame.read_back(status.gathered);
    run(std::move(frame));
    const auto gathered = gathered_read.as<uint32_t>();
    EXPECT_EQ(static_cast<size_t>(std::count(gathered.begin(), gathered.end(), 0u)) * sizeof(uint32_t),
              (before - rig.content().size()) * sizeof(gpu::RecordSurroundings));
    const auto words = read.as<uint32_t>();
    const size_t zeros = static_cast<size_t>(std::count(words.begin(), words.end(), 0u));
    EXPECT_EQ(zeros * sizeof(uint32_t), (before - rig.content().size()) * sizeof(gpu::RecordStatus));
    EXPECT_EQ(zeros + static_cast<size_t>(std::count(words.begin(), words.end(), 7u)), words.size());
}

}  // namespace
}  // namespace patina::reclaim_records_test
