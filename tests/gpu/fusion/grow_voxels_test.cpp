#include "passes/fusion/grow_voxels.h"

#include <numeric>

#include "engine/graph/enlargement.h"
#include "passes/state/label_map.h"
#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"

namespace patina::grow_voxels_test {
namespace {

class GrowVoxelsTest : public GpuTest {
  protected:
    FusionRig rig(uint32_t blocks, uint64_t chunk_bytes = uint64_t{1} << 27) {
        FusionSettings settings;
        settings.allocation_stride_px = 1;
        return FusionRig(device(), runner(),
                         {.voxel_m = 0.01f, .capacity_blocks = blocks, .max_chunk_bytes = chunk_bytes}, settings);
    }

    void grow(FusionRig& rig, uint32_t blocks) {
        const uint32_t before = rig.map().capacity();
        graph::Enlargement enlargement(device());
        rig.map().enlarge(enlargement, blocks);
        enlargement.allocate();
        graph::FrameGraph frame = runner().begin();
        enlargement.commit(frame);
        VoxelMapIds ids = rig.map().import(frame);
        add_grow_voxels(frame, rig.map(), ids, before);
        VoxelMap::keep(frame, ids);
        enlargement.keep(frame);
        run(std::move(frame));
        enlargement.accept();
    }

    void fuse_left(FusionRig& rig) { rig.fuse(camera_, left_, Image<float>(camera_.extent, 0.8f)); }
    void fuse_right(FusionRig& rig) { rig.fuse(camera_, right_, random_depth(camera_.extent, 21)); }

    const Intrinsics camera_{{40, 30}, 70, 70, 19.5, 14.5, {}};
    const RigidTransform left_ = reference::look_at({0, 0, -1}, {0, 0, -3});
    const RigidTransform right_ = reference::look_at({0.31, -0.23, -1.17}, {0.05, 0.02, 0.4});
};

TEST_F(GrowVoxelsTest, SurfaceStaysAndNewSurfaceFindsRoomWithinAChunkAndBeyond) {
    FusionRig large = rig(4096);
    fuse_left(large);
    fuse_right(large);
    const MapContent expected = large.content();
    ASSERT_GT(expected.size(), 300u);
    // Chunks of 128 blocks: the last one is replaced, or others come beside it, or both.
    for (const uint64_t chunk_bytes : {uint64_t{1} << 27, uint64_t{1} << 18}) {
        for (const uint32_t first : {160u, 256u}) {
            SCOPED_TRACE(text(first, " blocks, chunks of ", chunk_bytes, " bytes"));
            FusionRig small = rig(first, chunk_bytes);
            fuse_left(small);
            const MapContent before = small.content();
            ASSERT_EQ(small.counters().refused_blocks, 0u);
            grow(small, 600);
            EXPECT_EQ(small.content(), before);
            EXPECT_EQ(small.counters().table_keys, before.size());
            EXPECT_EQ(small.counters().free_blocks, 600 - before.size());
            fuse_right(small);
            EXPECT_EQ(small.counters().refused_blocks, 0u);
            EXPECT_EQ(small.content(), expected);
        }
    }
}

TEST_F(GrowVoxelsTest, EveryBlockIsFreeOrInUseOnceAndThoseFreeBeforeComeFirst) {
    FusionRig rig = this->rig(300);
    fuse_left(rig);
    const TableContent before = rig.table();
    grow(rig, 700);
    const TableContent after = rig.table();
    std::vector<uint32_t> ids = after.free_list;
    for (uint32_t block = 0; block < 700; ++block) {
        if (after.block_keys[block] != gpu::kEmptyKey) ids.push_back(block);
    }
    std::sort(ids.begin(), ids.end());
    std::vector<uint32_t> all(700);
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(ids, all);
    const std::vector<uint32_t> top(after.free_list.end() - static_cast<ptrdiff_t>(before.free_list.size()),
                                    after.free_list.end());
    EXPECT_EQ(top, before.free_list);
}

TEST_F(GrowVoxelsTest, SurfaceStaysWhenTheTableGrows) {
    FusionRig small = rig(32768), large = rig(33000);
    ASSERT_LT(small.map().table_slots(), large.map().table_slots());
    for (FusionRig* rig : {&small, &large}) fuse_left(*rig);
    grow(small, 33000);
    EXPECT_EQ(small.map().table_slots(), large.map().table_slots());
    EXPECT_EQ(small.content(), large.content());
    for (FusionRig* rig : {&small, &large}) fuse_right(*rig);
    EXPECT_EQ(small.content(), large.content());
}

TEST_F(GrowVoxelsTest, WhatIsNotSubmittedIsUndone) {
    FusionRig rig = this->rig(300);
    fuse_left(rig);
    const MapContent before = rig.content();
    const uint32_t slots = rig.map().table_slots();
    {
        graph::Enlargement enlargement(device());
        rig.map().enlarge(enlargement, 40000);
        enlargement.allocate();
        graph::FrameGraph frame = runner().begin();
        enlargement.commit(frame);
        EXPECT_EQ(rig.map().capacity(), 40000u);
    }
    EXPECT_EQ(rig.map().capacity(), 300u);
    EXPECT_EQ(rig.map().table_slots(), slots);
    EXPECT_EQ(rig.content(), before);
}

TEST_F(GrowVoxelsTest, WhatAFullPoolRefusedComesAgainWithTheNextFrameThatSeesIt) {
    FusionRig rig = this->rig(200);
    fuse_left(rig);
    fuse_right(rig);
    const uint32_t refused = rig.counters().refused_blocks;
    ASSERT_GT(refused, 50u);
    const std::set<reference::BlockCoordinates> before = rig.allocated();
    grow(rig, 4096);
    fuse_right(rig);
    EXPECT_EQ(rig.counters().refused_blocks, refused);
    EXPECT_EQ(rig.allocated().size(), before.size() + refused);
}

TEST_F(GrowVoxelsTest, WithoutMemoryTheMapStaysAsItIs) {
    vulkan::DeviceOptions options;
    options.fail_allocation_at = 20;
    vulkan::Device poor(options);
    graph::Runner runner(poor);
    VoxelMap map(poor, {.voxel_m = 0.01f, .capacity_blocks = 300});
    LabelMap labels(poor, map);
    uint32_t failures = 0;
    for (int attempt = 0; attempt < 3; ++attempt) {
        graph::Enlargement enlargement(poor);
        map.enlarge(enlargement, 600);
        labels.enlarge(enlargement, 600);
        try {
            enlargement.allocate();
        } catch (const vulkan::OutOfMemory&) {
            ++failures;
            EXPECT_EQ(map.capacity(), 300u);
            EXPECT_EQ(map.table_slots(), 131072u);
        }
    }
    EXPECT_EQ(failures, 1u);
}

}  // namespace
}  // namespace patina::grow_voxels_test
