#include "passes/fusion/visible_blocks.h"

#include <algorithm>
#include <bit>

#include "engine/core/shader_camera.h"
#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/reference/fusion/visible_blocks.h"

namespace patina::visible_blocks_test {
namespace {

constexpr int kTile = gpu::kTileEdge;

class VisibleBlocksTest : public GpuTest {
  protected:
    struct Seen {
        std::vector<reference::BlockCoordinates> blocks;
        std::vector<reference::DepthRange> tiles;  ///< far < near where nothing is
        glm::uvec3 groups;
    };

    Seen look(FusionRig& rig, const reference::ViewVolume& view) {
        const std::vector<uint32_t> keys = rig.table().block_keys;
        graph::FrameGraph frame = runner().begin();
        const VisibleBlocks visible = add_visible_blocks(
            frame, rig.map(), rig.map().import(frame), make_camera(view.camera, view.world_from_camera),
            static_cast<float>(view.near_m), static_cast<float>(view.far_m));
        const graph::Readback list = frame.read_back(visible.list), tiles = frame.read_back(visible.tiles),
                              arguments = frame.read_back(visible.arguments);
        run(std::move(frame));
        Seen seen;
        const auto ids = list.as<uint32_t>();
        for (uint32_t i = 0; i < ids[0]; ++i) seen.blocks.push_back(coordinates_of_key(keys.at(ids[1 + i])));
        for (const gpu::TileRange& tile : tiles.as<gpu::TileRange>()) {
            const bool empty = tile.near_bits == UINT32_MAX;
            seen.tiles.push_back({empty ? 1.0 : std::bit_cast<float>(tile.near_bits),
                                  empty ? 0.0 : std::bit_cast<float>(~tile.far_bits_inverted)});
        }
        const auto groups = arguments.as<uint32_t>();
        seen.groups = {groups[0], groups[1], groups[2]};
        return seen;
    }

    /// A room full of blocks around the origin.
    FusionRig filled() {
        FusionSettings settings;
        settings.allocation_stride_px = 1;
        FusionRig rig(device(), runner(), {0.01f}, settings);
        const Intrinsics wide{{96, 64}, 40, 40, 47.5, 31.5, {}};
        for (int i = 0; i < 4; ++i) {
            const RigidTransform pose = reference::orbit({0, 0, 0}, 0.1, 4)[static_cast<size_t>(i)];
            rig.fuse(wide, pose, random_depth(wide.extent, static_cast<uint32_t>(i)));
        }
        return rig;
    }
};

TEST_F(VisibleBlocksTest, WhatTheCameraSeesIsListedOnceAndItsDepthsAreBounded) {
    FusionRig rig = filled();
    const double block_m = 0.08;
    const std::set<reference::BlockCoordinates> all = rig.allocated();
    ASSERT_GT(all.size(), 1000u);
    for (const Extent2D extent : {Extent2D{1, 1}, {13, 7}, {65, 33}, {160, 120}}) {
        for (const RigidTransform& pose : reference::orbit({0.2, 0.1, 0}, 0.7, 5)) {
            const reference::ViewVolume view{pinhole_camera(extent), pose, 0.1, 2.1};
            const Seen seen = look(rig, view);
            const std::set<reference::BlockCoordinates> listed(seen.blocks.begin(), seen.blocks.end());
            ASSERT_EQ(listed.size(), seen.blocks.size());
            const uint32_t tiles_x = (extent.width + kTile - 1) / kTile;
            for (const reference::BlockCoordinates& block : all) {
                const glm::dvec3 low = glm::dvec3(block[0], block[1], block[2]) * block_m;
                for (const auto& [tile, range] : reference::seen_tiles(view, kTile, low, block_m)) {
                    ASSERT_TRUE(listed.contains(block));
                    const reference::DepthRange bound =
                        seen.tiles.at(static_cast<size_t>(tile[1]) * tiles_x + static_cast<size_t>(tile[0]));
                    ASSERT_LE(bound.near_m, range.near_m + 1e-5);
                    ASSERT_GE(bound.far_m, range.far_m - 1e-5);
                }
                // With the half voxel by which blocks are widened. Where a block reaches before the near plane, the
                // box around its projection is wide on purpose.
                const glm::dvec3 center = low + 0.5 * block_m;
                const double radius = 0.8661 * (block_m + 0.01) + 1e-5;
                const double depth = glm::dot(glm::dvec3(pose[2]), center - glm::dvec3(pose[3]));
                if (depth - radius > view.near_m && reference::outside_view(view, center, radius)) {
                    ASSERT_FALSE(listed.contains(block));
                }
            }
        }
    }
}

TEST_F(VisibleBlocksTest, SmallVoxelsShortenTheView) {
    const gpu::Camera camera = make_camera({{512, 424}, 365, 365, 255.5, 211.5, {}}, RigidTransform(1));
    EXPECT_EQ(view_reach_m(camera, 0.005f, 6), 6.0f);
    // The frustum's corners are 1.8213 m apart in a distance of 1 m; a cube of 2^25 cells has 322 of 2 cm on an edge,
    // of which 318 serve the frustum.
    EXPECT_NEAR(view_reach_m(camera, 0.0025f, 6), 318 * 0.02 / 1.8213, 2e-3);
    EXPECT_EQ(view_reach_m(camera, 0.0025f, 12), view_reach_m(camera, 0.0025f, 6));
}

TEST_F(VisibleBlocksTest, RangesAreNoWiderThanTheBlocks) {
    const Intrinsics camera{{64, 64}, 60, 60, 31.5, 31.5, {}};
    FusionRig rig(device(), runner(), {0.01f});
    // A frontal wall of 0.03 to 0.04 m truncation at 1 m: blocks from 0.96 to 1.04 m.
    for (int i = 0; i < 4; ++i) rig.fuse(camera, RigidTransform(1.0), Image<float>(camera.extent, 1.0f));
    const Seen seen = look(rig, {camera, RigidTransform(1.0), 0.1, 4});
    for (const reference::DepthRange& range : seen.tiles) {
        EXPECT_NEAR(range.near_m, 0.96 - 0.005, 1e-4);
        EXPECT_NEAR(range.far_m, 1.04 + 0.005, 1e-4);
    }
}

TEST_F(VisibleBlocksTest, ArgumentsCoverTheList) {
    // A wall large enough for several rows of groups, looked at from far enough to see all of it.
    const Intrinsics wide{{96, 64}, 40, 40, 47.5, 31.5, {}};
    FusionRig rig(device(), runner(), {0.01f});
    for (int i = 0; i < 4; ++i) rig.fuse(wide, RigidTransform(1.0), Image<float>(wide.extent, 2.0f));
    const reference::ViewVolume all{wide, reference::look_at({0, 0, -1.5}, {0, 0, 0}), 0.1, 5};
    const Seen seen = look(rig, all);
    ASSERT_GT(seen.blocks.size(), 2 * gpu::kGroupsPerRow) << "the list must need several rows";
    EXPECT_EQ(seen.blocks.size(), rig.allocated().size());
    EXPECT_EQ(seen.groups,
              glm::uvec3(gpu::kGroupsPerRow, (seen.blocks.size() + gpu::kGroupsPerRow - 1) / gpu::kGroupsPerRow, 1));
    FusionRig empty(device(), runner());
    const Seen nothing = look(empty, all);
    EXPECT_TRUE(nothing.blocks.empty());
    EXPECT_EQ(nothing.groups, glm::uvec3(1));
    for (const reference::DepthRange& range : nothing.tiles) EXPECT_LT(range.far_m, range.near_m);
}

TEST_F(VisibleBlocksTest, CamerasBeyondAllCoordinatesSeeNothing) {
    FusionRig rig = filled();
    const Intrinsics camera = pinhole_camera({16, 12});
    for (const double far_m : {1e9, -1e12, 1e30}) {
        RigidTransform pose(1.0);
        pose[3] = glm::dvec4(far_m, -far_m, far_m, 1);
        EXPECT_TRUE(look(rig, {camera, pose, 0.1, 2.1}).blocks.empty());
        graph::FrameGraph frame = runner().begin();
        const VisibleBlocks visible =
            add_visible_blocks(frame, rig.map(), rig.map().import(frame), make_camera(camera, pose), 0.1f, 2.1f);
        const graph::Readback read = frame.read_back(visible.view);
        run(std::move(frame));
        const gpu::ViewParams params = read.as<gpu::ViewParams>().front();
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(std::abs(int64_t{params.grid_low[axis]}), (1 << 27) + 1);
            EXPECT_LE(params.grid_size[axis], 64u);
        }
    }
}

}  // namespace
}  // namespace patina::visible_blocks_test
