// The fusion's oracles against answers known in closed form.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/reference/fusion/allocate_blocks.h"
#include "tests/reference/fusion/integrate.h"
#include "tests/reference/fusion/raycast.h"
#include "tests/reference/fusion/shade_color.h"
#include "tests/reference/fusion/visible_blocks.h"
#include "tests/reference/scenes/analytic_scene.h"

namespace patina::reference::fusion_reference_test {
namespace {

const Intrinsics kCamera{{64, 48}, 60, 60, 31.5, 23.5, {}};

/// Blocks around the origin whose voxels hold a field's distance.
Volume sampled(const DistanceField& field, double voxel_m, int half_blocks) {
    Volume volume{voxel_m, {}};
    for (int z = -half_blocks; z < half_blocks; ++z) {
        for (int y = -half_blocks; y < half_blocks; ++y) {
            for (int x = -half_blocks; x < half_blocks; ++x) {
                std::vector<Voxel>& voxels = volume.blocks[{x, y, z}];
                for (int i = 0; i < 512; ++i) voxels.push_back({field(volume.center_m({x, y, z}, i)), 1, {}, false});
            }
        }
    }
    return volume;
}

TEST(FusionReference, TheBandOfOneRayTouchesTheBlocksInItsRow) {
    const Intrinsics camera{{1, 1}, 100, 100, 0, 0, {}};
    RigidTransform pose(1.0);
    pose[3] = {0.25, 0.35, 0, 1};
    const Band band{0.1, 0.12, 0.08, 4};
    // 1 m -+ 0.2 m along z.
    const std::set<BlockCoordinates> expected = {{2, 3, 8}, {2, 3, 9}, {2, 3, 10}, {2, 3, 11}};
    EXPECT_EQ(touched_blocks(Image<float>({1, 1}, 1.0f), camera, pose, band, -1e-6), expected);
    EXPECT_TRUE(touched_blocks(Image<float>({1, 1}, 4.1f), camera, pose, band, 0).empty());
    EXPECT_TRUE(touched_blocks(Image<float>({1, 1}, 0.0f), camera, pose, band, 0).empty());
}

TEST(FusionReference, ACubeOnTheAxisIsSeenInTheMiddleBetweenItsFaces) {
    const ViewVolume view{kCamera, RigidTransform(1.0), 0.1, 3};
    const auto tiles = seen_tiles(view, 64, glm::dvec3(-0.05, -0.05, 1), 0.1);
    ASSERT_EQ(tiles.size(), 1u);
    EXPECT_DOUBLE_EQ(tiles.begin()->second.near_m, 1.0);
    EXPECT_DOUBLE_EQ(tiles.begin()->second.far_m, 1.1);
    EXPECT_TRUE(seen_tiles(view, 64, glm::dvec3(-0.05, -0.05, -1), 0.1).empty());
    EXPECT_TRUE(seen_tiles(view, 64, glm::dvec3(-0.05, -0.05, 3.1), 0.1).empty());
    // The image ends 32 px = 0.533 m right of the axis at 1 m.
    EXPECT_TRUE(outside_view(view, {0.7, 0, 1}, 0.1));
    EXPECT_FALSE(outside_view(view, {0.6, 0, 1}, 0.1));
    EXPECT_TRUE(outside_view(view, {0, 0, -0.1}, 0.1));
    EXPECT_TRUE(outside_view(view, {0, 0, 3.2}, 0.1));
}

TEST(FusionReference, SlopesOfAPlaneAreThePlanes) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.2, -1));
    const DistanceField plane = half_space(normal, glm::dot(normal, {0, 0, 1.5}));
    const Image<float> depth_m = render_depth(plane, kCamera, RigidTransform(1.0), 4);
    const Image<Slope> slopes = measure_slope(depth_m, kCamera);
    for (uint32_t y = 1; y + 1 < 48; ++y) {
        for (uint32_t x = 1; x + 1 < 64; ++x) {
            const glm::dvec3 ray((x - 31.5) / 60, (y - 23.5) / 60, 1);
            const double z = depth_m.at(x, y), facing = glm::dot(normal, ray);
            // z = d / (n . ray), so that dz/du = -z nx / fx / (n . ray); differences over two pixels and single
            // precision take their part.
            EXPECT_NEAR(slopes.at(x, y).depth_per_px.x, -z * normal.x / 60 / facing, 2e-5);
            EXPECT_NEAR(slopes.at(x, y).depth_per_px.y, -z * normal.y / 60 / facing, 2e-5);
            EXPECT_NEAR(slopes.at(x, y).plane_factor, -facing, 1e-3);
        }
    }
}

TEST(FusionReference, AFrontalPlaneIsIntegratedByTheBook) {
    Observation seen{kCamera, RigidTransform(1.0), Image<float>({64, 48}, 1.0f), {}, {}};
    seen.slope = measure_slope(seen.depth_m, kCamera);
    const Fusion fusion{0.02, 0, 4, 16, 40, 0.01, 32};
    const auto sdf_at = [&](double z) { return integrate({}, {0, 0, z}, seen, fusion); };
    EXPECT_NEAR(sdf_at(0.99).sdf_m, 0.01, 1e-12);
    EXPECT_EQ(sdf_at(0.99).weight, 16);
    EXPECT_NEAR(sdf_at(0.5).sdf_m, 0.02, 1e-12);
    EXPECT_NEAR(sdf_at(1.01).sdf_m, -0.01, 1e-12);
    EXPECT_EQ(sdf_at(1.01).weight, 6);  // half the band behind the surface: 16 / 2^1.5, rounded
    EXPECT_EQ(sdf_at(1.021).weight, 0);
    EXPECT_EQ(integrate({}, {0.6, 0, 1}, seen, fusion).weight, 0);  // beside the image

    const Voxel before{0.02, 32, {}, false};
    const Voxel after = integrate(before, {0, 0, 0.995}, seen, fusion);
    EXPECT_NEAR(after.sdf_m, (0.02 * 32 + 0.005 * 16) / 48, 1e-12);
    EXPECT_EQ(after.weight, 40);

    seen.color = {kCamera, RigidTransform(1.0), Image<glm::vec4>({64, 48}, glm::vec4(0.5f, 0.25f, 1, 1))};
    const Voxel colored = integrate({0, 16, glm::dvec3(1), true}, {0, 0, 0.995}, seen, fusion);
    EXPECT_EQ(colored.color, glm::dvec3(0.75, 0.625, 1));                 // 16 of 32
    EXPECT_EQ(integrate({}, {0, 0, 0.98}, seen, fusion).colored, false);  // outside the colour's band
}

TEST(FusionReference, RaysMeetASampledSphereWhereItIs) {
    const DistanceField field = sphere({0, 0, 0}, 0.2);
    const Volume volume = sampled(field, 0.02, 2);
    const RigidTransform pose = look_at({0.1, -0.2, -1}, {0, 0, 0});
    const Image<float> got = raycast(volume, kCamera, pose, 0.1, 2), truth = render_depth(field, kCamera, pose, 2);
    size_t hits = 0, differing = 0;
    for (uint32_t y = 0; y < 48; ++y) {
        for (uint32_t x = 0; x < 64; ++x) {
            const double expected = truth.at(x, y), depth = got.at(x, y);
            hits += expected != 0;
            differing += (expected == 0) != (depth == 0);
            if (expected == 0 || depth == 0) continue;
            const glm::dvec3 ray = glm::dvec3((x - 31.5) / 60, (y - 23.5) / 60, 1);
            const glm::dvec3 point(pose * glm::dvec4(ray * expected, 1));
            const double facing = glm::dot(glm::normalize(point), -glm::normalize(glm::dmat3(pose) * ray));
            // A trilinear interpolant is off by at most h^2 / 8 times the sum of the curvatures, 2 / r.
            EXPECT_NEAR(depth, expected, 0.02 * 0.02 / 8 * 10 / std::max(facing, 0.1)) << x << ", " << y;
        }
    }
    EXPECT_GT(hits, 300u);
    EXPECT_LE(differing, hits / 20);
    // From within, the surface is met from its back alone.
    EXPECT_EQ(raycast(volume, kCamera, RigidTransform(1.0), 0.01, 2).pixels(), std::vector<float>(64 * 48, 0.0f));
}

TEST(ShadeColorReference, MeansTheColouredVoxelsByTheirShares) {
    reference::Volume volume;
    volume.voxel_m = 0.01;
    auto& voxels = volume.blocks[{0, 0, 0}];
    voxels.resize(512);
    voxels[0].colored = voxels[1].colored = true;
    voxels[0].color = {1, 0, 0};
    voxels[1].color = {0, 1, 0};
    const glm::dvec4 quarter = reference::color_at(volume, {0.0075, 0.005, 0.005});
    EXPECT_NEAR(quarter.r, 0.75, 1e-12);
    EXPECT_NEAR(quarter.g, 0.25, 1e-12);
    EXPECT_EQ(quarter.a, 1);
    // Off towards voxels without colour, what has one counts alone.
    EXPECT_NEAR(reference::color_at(volume, {0.005, 0.009, 0.005}).r, 1, 1e-12);
    EXPECT_EQ(reference::color_at(volume, {0.045, 0.045, 0.045}), glm::dvec4(0));
}

}  // namespace
}  // namespace patina::reference::fusion_reference_test
