#include "passes/fusion/remove_empty_blocks.h"

#include <algorithm>

#include "engine/core/shader_camera.h"
#include "passes/fusion/visible_blocks.h"
#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"

namespace patina::remove_empty_blocks_test {
namespace {

using Blocks = std::set<reference::BlockCoordinates>;

const Intrinsics kCamera{{96, 80}, 90, 90, 47.5, 39.5, {}};
const RigidTransform kPose(1.0);

FusionSettings every_pixel() {
    FusionSettings settings;
    settings.allocation_stride_px = 1;
    return settings;
}

Image<float> wall(float depth_m) { return Image<float>(kCamera.extent, depth_m); }

/// The blocks of a map in which some voxel has been seen near the surface.
Blocks with_surface(FusionRig& rig) {
    const double limit_m = 0.95 * rig.reference_fusion().truncation_m;
    Blocks blocks;
    for (const auto& [coordinates, voxels] : rig.volume().blocks) {
        const bool holds = std::any_of(voxels.begin(), voxels.end(), [&](const reference::Voxel& voxel) {
            return voxel.weight > 0 && std::abs(voxel.sdf_m) < limit_m;
        });
        if (holds) blocks.insert(coordinates);
    }
    return blocks;
}

/// Every block in use has one slot that names it, every other slot is free, and every id is either in use or free.
void expect_consistent(FusionRig& rig) {
    const TableContent table = rig.table();
    std::multiset<uint32_t> ids(table.free_list.begin(), table.free_list.end());
    size_t used = 0;
    for (uint32_t slot = 0; slot < table.keys.size(); ++slot) {
        if (table.keys[slot] == gpu::kEmptyKey || table.blocks[slot] == gpu::kNoBlock) continue;
        ++used;
        ids.insert(table.blocks[slot]);
        ASSERT_EQ(table.block_keys.at(table.blocks[slot]), table.keys[slot]);
    }
    const auto in_use =
        table.block_keys.size() -
        static_cast<size_t>(std::count(table.block_keys.begin(), table.block_keys.end(), gpu::kEmptyKey));
    EXPECT_EQ(used, in_use);
    ASSERT_EQ(ids.size(), table.block_keys.size());
    uint32_t expected = 0;
    for (const uint32_t id : ids) ASSERT_EQ(id, expected++);
}

class RemoveEmptyBlocksTest : public GpuTest {};

TEST_F(RemoveEmptyBlocksTest, OnlyBlocksWithoutSurfaceGoAndTheOthersStayAsTheyAre) {
    FusionRig rig(device(), runner(), {0.005f, 16384}, every_pixel());
    const reference::DistanceField ball = reference::sphere({0, 0, 1}, 0.2);
    rig.fuse(kCamera, kPose, reference::render_depth(ball, kCamera, kPose, 3));
    rig.fuse(kCamera, kPose, random_depth(kCamera.extent, 3));
    const MapContent before = rig.content();
    const Blocks kept = with_surface(rig);
    ASSERT_GT(kept.size(), 100u);
    ASSERT_LT(kept.size() + 100, before.size());

    rig.remove_empty_blocks(kCamera, kPose);
    EXPECT_EQ(rig.allocated(), kept);
    const MapContent after = rig.content();
    for (const auto& [coordinates, block] : after) EXPECT_EQ(block, before.at(coordinates));
    const gpu::MapCounters counters = rig.counters();
    EXPECT_EQ(counters.deleted_blocks, before.size() - kept.size());
    EXPECT_EQ(counters.table_keys, kept.size());
    EXPECT_EQ(counters.free_blocks, 16384 - kept.size());
    expect_consistent(rig);

    rig.remove_empty_blocks(kCamera, kPose);
    EXPECT_EQ(rig.content(), after);
    EXPECT_EQ(rig.counters().deleted_blocks, counters.deleted_blocks);
    expect_consistent(rig);
}

TEST_F(RemoveEmptyBlocksTest, BlocksOutOfSightStay) {
    FusionRig rig(device(), runner(), {0.01f, 4096}, every_pixel());
    Image<float> flying = random_depth(kCamera.extent, 3);
    rig.fuse(kCamera, kPose, flying);
    const MapContent before = rig.content();
    rig.remove_empty_blocks(kCamera, reference::look_at({0, 0, 0}, {0, 0, -1}));
    EXPECT_EQ(rig.content(), before);
    EXPECT_EQ(rig.counters().deleted_blocks, 0u);
    expect_consistent(rig);
}

TEST_F(RemoveEmptyBlocksTest, SurfaceIsSeenAndFusedOnAsIfNothingHadBeenRemoved) {
    FusionRig with(device(), runner(), {0.01f, 8192}, every_pixel()),
        without(device(), runner(), {0.01f, 8192}, every_pixel());
    const reference::DistanceField ball = reference::sphere({0, 0, 0}, 0.25);
    for (const RigidTransform& pose : reference::orbit({0, 0, 0}, 0.9, 12)) {
        const Image<float> depth_m = reference::render_depth(ball, kCamera, pose, 3);
        for (FusionRig* rig : {&with, &without}) rig->fuse(kCamera, pose, depth_m);
        with.remove_empty_blocks(kCamera, pose);
        expect_consistent(with);
    }
    EXPECT_GT(with.counters().deleted_blocks, 0u);
    const Blocks kept = with_surface(without);
    const MapContent a = with.content(), b = without.content();
    // Free space before the surface may have been forgotten in between; where there is surface all is the same but
    // for blocks that were empty at first.
    size_t same = 0;
    for (const auto& block : kept) {
        ASSERT_TRUE(a.contains(block));
        same += a.at(block) == b.at(block);
    }
    EXPECT_GT(same, kept.size() * 8 / 10);
    const RigidTransform pose = reference::look_at({0.3, -0.4, -0.8}, {0, 0, 0});
    const FusionRig::View seen = with.raycast(kCamera, pose), expected = without.raycast(kCamera, pose);
    for (size_t i = 0; i < seen.position_m.pixels().size(); ++i) {
        const float depth = seen.position_m.pixels()[i].w, other = expected.position_m.pixels()[i].w;
        if (depth == 0 || other == 0) continue;
        EXPECT_NEAR(depth, other, 0.002f);
    }
}

TEST_F(RemoveEmptyBlocksTest, FreedBlocksAreUsedAgainAndRefusedKeysGetAnotherChance) {
    FusionRig rig(device(), runner(), {0.01f, 300}, every_pixel());
    // Flying pixels take all there is and hold nothing.
    Image<float> flying(kCamera.extent);
    for (size_t i = 0; i < flying.pixels().size(); ++i) flying.pixels()[i] = 0.5f + 0.1f * float(i * 7 % 11);
    rig.fuse(kCamera, kPose, flying);
    const gpu::MapCounters full = rig.counters();
    ASSERT_GT(full.refused_blocks, 1000u);
    ASSERT_EQ(full.high_water, 300 - full.free_blocks);
    rig.fuse(kCamera, kPose, wall(1.0f));
    EXPECT_TRUE(with_surface(rig).size() < 50);

    rig.remove_empty_blocks(kCamera, kPose);
    expect_consistent(rig);
    const Blocks kept = rig.allocated();
    EXPECT_EQ(kept, with_surface(rig));
    EXPECT_EQ(rig.counters().table_keys, kept.size());
    EXPECT_EQ(rig.counters().free_blocks, 300 - kept.size());

    FusionRig fresh(device(), runner(), {0.01f, 300}, every_pixel());
    rig.fuse(kCamera, kPose, wall(1.0f));
    fresh.fuse(kCamera, kPose, wall(1.0f));
    ASSERT_EQ(fresh.counters().refused_blocks, 0u);
    EXPECT_EQ(rig.allocated(), fresh.allocated());
    expect_consistent(rig);
    // Reused blocks start empty: those that were not there before are what a fresh map has.
    const MapContent got = rig.content(), expected = fresh.content();
    for (const auto& [coordinates, block] : expected) {
        if (!kept.contains(coordinates)) {
            EXPECT_EQ(got.at(coordinates), block);
        }
    }
}

TEST_F(RemoveEmptyBlocksTest, AStaleListFreesNothingTwice) {
    FusionRig rig(device(), runner(), {0.01f, 4096}, every_pixel());
    Image<float> flying(kCamera.extent);
    for (size_t i = 0; i < flying.pixels().size(); ++i) flying.pixels()[i] = 0.5f + 0.1f * float(i * 7 % 11);
    rig.fuse(kCamera, kPose, flying);
    const size_t blocks = rig.allocated().size();
    ASSERT_GT(blocks, 100u);

    graph::FrameGraph frame = runner().begin();
    const gpu::Camera camera = make_camera(kCamera, kPose);
    const gpu::FusionParams values = make_fusion_params(rig.map(), rig.settings(), camera, camera, 0, 0);
    const auto params = frame.upload<gpu::FusionParams>("params", std::span(&values, 1));
    VoxelMapIds ids = rig.map().import(frame);
    const VisibleBlocks visible = add_visible_blocks(frame, rig.map(), ids, camera, 0.1f, 4.0f);
    add_remove_empty_blocks(frame, rig.map(), ids, visible, params);
    add_remove_empty_blocks(frame, rig.map(), ids, visible, params);
    VoxelMap::keep(frame, ids);
    run(std::move(frame));
    EXPECT_EQ(rig.counters().deleted_blocks, blocks);
    EXPECT_EQ(rig.counters().free_blocks, 4096u);
    expect_consistent(rig);
}

}  // namespace
}  // namespace patina::remove_empty_blocks_test
