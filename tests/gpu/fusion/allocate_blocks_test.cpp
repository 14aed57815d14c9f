#include "passes/fusion/allocate_blocks.h"

#include <algorithm>

#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/reference/fusion/allocate_blocks.h"

namespace patina::allocate_blocks_test {
namespace {

using ::testing::IsSubsetOf;
using Blocks = std::set<reference::BlockCoordinates>;

// A block's edge times single precision's 2^-24, for coordinates of a few metres, with a margin.
constexpr double kRoundingM = 1e-5;

reference::Band band_of(const FusionRig& rig, double block_m) {
    const reference::Fusion fusion = rig.reference_fusion();
    return {block_m, fusion.truncation_m, fusion.truncation_slope, fusion.max_depth_m};
}

class AllocateBlocksTest : public GpuTest {
  protected:
    const Intrinsics camera_{{80, 60}, 70, 71, 38.2, 30.7, {}};
    const RigidTransform pose_ = reference::look_at({0.31, -0.23, -1.17}, {0.05, 0.02, 0.4});
};

TEST_F(AllocateBlocksTest, TheBandsOfAllReadingsAreAllocatedAndNothingElse) {
    for (const float voxel_m : {0.005f, 0.012f}) {
        FusionSettings settings;
        settings.allocation_stride_px = 1;
        FusionRig rig(device(), runner(), {voxel_m}, settings);
        const Image<float> depth_m = random_depth(camera_.extent, 4);
        rig.fuse(camera_, pose_, depth_m);
        const reference::Band band = band_of(rig, 8.0 * voxel_m);
        const Blocks got = rig.allocated();
        EXPECT_THAT(reference::touched_blocks(depth_m, camera_, pose_, band, -kRoundingM), IsSubsetOf(got));
        EXPECT_THAT(got, IsSubsetOf(reference::touched_blocks(depth_m, camera_, pose_, band, kRoundingM)));
        EXPECT_GT(got.size(), 500u);
    }
}

TEST_F(AllocateBlocksTest, EveryPixelHasItsTurnWithinTheSquareOfTheStride) {
    FusionSettings settings;
    settings.allocation_stride_px = 3;
    FusionRig rig(device(), runner(), {0.02f}, settings);
    const Image<float> depth_m = random_depth(camera_.extent, 8);
    const reference::Band band = band_of(rig, 0.16);
    rig.fuse(camera_, pose_, depth_m);
    EXPECT_THAT(rig.allocated(), IsSubsetOf(reference::touched_blocks(depth_m, camera_, pose_, band, kRoundingM, 3)));
    for (int frame = 1; frame < 9; ++frame) rig.fuse(camera_, pose_, depth_m);
    EXPECT_THAT(reference::touched_blocks(depth_m, camera_, pose_, band, -kRoundingM), IsSubsetOf(rig.allocated()));
}

TEST_F(AllocateBlocksTest, ARayInABlockBoundaryReachesTheEndOfItsBand) {
    const Intrinsics camera{{1, 1}, 100, 100, 0, 0, {}};
    FusionSettings settings;
    settings.truncation_m = 0.07f;
    settings.truncation_slope = 0;
    FusionRig rig(device(), runner(), {}, settings);
    for (int frame = 0; frame < 4; ++frame) rig.fuse(camera, RigidTransform(1.0), Image<float>({1, 1}, 1.02f));
    // 0.95 to 1.09 m in blocks of 0.04 m.
    EXPECT_EQ(rig.allocated(), (Blocks{{0, 0, 23}, {0, 0, 24}, {0, 0, 25}, {0, 0, 26}, {0, 0, 27}}));
}

TEST_F(AllocateBlocksTest, MissingAndFarReadingsAllocateNothing) {
    FusionRig rig(device(), runner());
    const float too_far = rig.settings().max_depth_m + 0.001f;
    for (const float depth : {0.0f, too_far, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
        for (int frame = 0; frame < 4; ++frame) rig.fuse(camera_, pose_, Image<float>(camera_.extent, depth));
    }
    EXPECT_TRUE(rig.allocated().empty());
    EXPECT_EQ(rig.counters().table_keys, 0u);
}

TEST_F(AllocateBlocksTest, AFullPoolRefusesByKeyAndLeavesSurfaceAlone) {
    const Intrinsics small{{40, 30}, 70, 70, 19.5, 14.5, {}};
    const RigidTransform away = reference::look_at({0, 0, -1}, {0, 0, -3});
    const Image<float> big = random_depth(camera_.extent, 21);
    FusionSettings settings;
    settings.allocation_stride_px = 1;

    std::optional<Blocks> accepted;
    std::optional<uint32_t> refused;
    for (int attempt = 0; attempt < 5; ++attempt) {
        FusionRig rig(device(), runner(), {0.01f, 200}, settings);
        rig.fuse(small, away, Image<float>(small.extent, 0.8f));
        const MapContent before = rig.content();
        ASSERT_LT(before.size(), 150u);
        ASSERT_EQ(rig.counters().refused_blocks, 0u);

        rig.fuse(camera_, pose_, big);
        const MapContent after = rig.content();
        for (const auto& [coordinates, block] : before) EXPECT_EQ(after.at(coordinates), block);
        const gpu::MapCounters counters = rig.counters();
        EXPECT_EQ(counters.refused_blocks, counters.table_keys - after.size());
        EXPECT_EQ(counters.free_blocks, 200 - after.size());
        // Whole bins of 1/1024 of the keys: what remains free is less than the largest of them.
        EXPECT_LE(counters.free_blocks, 10u);
        if (!accepted) {
            const reference::Band band = band_of(rig, 0.08);
            const size_t least = reference::touched_blocks(big, camera_, pose_, band, -kRoundingM).size();
            const size_t most = reference::touched_blocks(big, camera_, pose_, band, kRoundingM).size();
            const size_t wanted = counters.table_keys - before.size();
            EXPECT_GE(wanted, least);
            EXPECT_LE(wanted, most);
        }
        const Blocks now = rig.allocated();
        if (accepted) {
            EXPECT_EQ(now, *accepted);
        }
        if (refused) {
            EXPECT_EQ(counters.refused_blocks, *refused);
        }
        accepted = now;
        refused = counters.refused_blocks;

        // Refused once, a key is not counted again.
        rig.fuse(camera_, pose_, big);
        EXPECT_EQ(rig.counters().refused_blocks, *refused);
    }
}

TEST_F(AllocateBlocksTest, SettingsThatVoxelsCannotHoldAreErrors) {
    const VoxelMap map(device(), {});
    const auto with = [&](auto change) {
        FusionSettings settings;
        change(settings);
        return [&map, settings] { make_fusion_params(map, settings, {}, {}, 0, 0); };
    };
    EXPECT_THAT(with([](FusionSettings& s) { s.truncation_m = 0.07f; }),
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("voxels of 0.005 m hold at most 0.08 m")));
    EXPECT_THAT(with([](FusionSettings& s) { s.max_weight = 5000; }),
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("is 5000 samples, it must be 1 to 4095")));
}

}  // namespace
}  // namespace patina::allocate_blocks_test
