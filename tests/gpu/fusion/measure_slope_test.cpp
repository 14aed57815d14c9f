#include "passes/fusion/measure_slope.h"

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/reference/fusion/measure_slope.h"
#include "tests/reference/scenes/analytic_scene.h"

namespace patina::measure_slope_test {
namespace {

using reference::Slope;

class MeasureSlopeTest : public GpuTest {
  protected:
    Image<Slope> measure(const Image<float>& depth_m, const Intrinsics& camera) {
        graph::FrameGraph frame = runner().begin();
        const auto depth = frame.upload("depth_m", {depth_m.extent(), vulkan::Format::kR32f},
                                        std::as_bytes(std::span(depth_m.pixels())));
        const graph::Readback read = frame.read_back(add_measure_slope(frame, depth, camera));
        run(std::move(frame));
        Image<Slope> slopes(depth_m.extent());
        const auto packed = read.as<uint32_t>();
        const auto per_px = [](uint32_t bits) {
            const int value = static_cast<int>(bits & 0x7ff);
            return (value < 1024 ? value : value - 2048) * 0.064 / 1023;
        };
        for (size_t i = 0; i < packed.size(); ++i) {
            slopes.pixels()[i] = {
                {per_px(packed[i]), per_px(packed[i] >> 11)}, (packed[i] >> 22 & 0x1ff) / 511.0, packed[i] >> 31 != 0};
        }
        return slopes;
    }
};

constexpr double kPerPxStep = 0.064 / 1023, kFactorStep = 1.0 / 511;

TEST_F(MeasureSlopeTest, APlaneHasItsOwnSlopeEverywhere) {
    const Intrinsics camera = pinhole_camera({65, 33});
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.2, -1));
    const reference::DistanceField plane = reference::half_space(normal, glm::dot(normal, {0, 0, 1.5}));
    const Image<Slope> slopes = measure(reference::render_depth(plane, camera, RigidTransform(1.0), 4), camera);
    for (uint32_t y = 0; y < 33; ++y) {
        for (uint32_t x = 0; x < 65; ++x) {
            const glm::dvec3 ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
            const double facing = glm::dot(normal, ray), z = glm::dot(normal, {0, 0, 1.5}) / facing;
            // The picture's edge has a neighbour on one side only: half a pixel of curvature.
            const double tolerance = kPerPxStep / 2 + 4e-4;
            EXPECT_NEAR(slopes.at(x, y).depth_per_px.x, -z * normal.x / camera.fx / facing, tolerance);
            EXPECT_NEAR(slopes.at(x, y).depth_per_px.y, -z * normal.y / camera.fy / facing, tolerance);
            // Stored as at most 1, though a surface that faces an oblique ray has the ray's length there.
            EXPECT_NEAR(slopes.at(x, y).plane_factor, std::min(-facing, 1.0), 0.006);
        }
    }
}

TEST_F(MeasureSlopeTest, NeighboursAcrossAJumpAreLeftOut) {
    const Intrinsics camera = pinhole_camera({16, 16});
    Image<float> depth_m(camera.extent, 1.0f);
    for (uint32_t y = 0; y < 16; ++y) {
        for (uint32_t x = 8; x < 16; ++x) depth_m.at(x, y) = 1.1f;
        depth_m.at(4, y) = y == 5 ? 1.05f : 1.0f;  // a flying pixel, alone
    }
    depth_m.at(12, 12) = 0;
    const Image<Slope> slopes = measure(depth_m, camera);
    EXPECT_EQ(slopes.at(7, 8).depth_per_px, glm::dvec2(0));
    EXPECT_EQ(slopes.at(8, 8).depth_per_px, glm::dvec2(0));
    EXPECT_GT(slopes.at(7, 8).plane_factor, 0.99);
    EXPECT_EQ(slopes.at(4, 5).plane_factor, 0);
    EXPECT_EQ(slopes.at(12, 12).plane_factor, 0);
    EXPECT_GT(slopes.at(11, 12).plane_factor, 0.9);
}

TEST_F(MeasureSlopeTest, WhatIsFartherKnowsThatItLiesBesideAnEdge) {
    const Intrinsics camera = pinhole_camera({16, 16});
    Image<float> depth_m(camera.extent, 1.0f);
    for (uint32_t y = 8; y < 16; ++y) {
        for (uint32_t x = 8; x < 16; ++x) depth_m.at(x, y) = 1.1f;
    }
    depth_m.at(12, 12) = 0;  // no reading is no edge
    const Image<Slope> slopes = measure(depth_m, camera);
    for (uint32_t y = 0; y < 16; ++y) {
        for (uint32_t x = 0; x < 16; ++x) {
            const bool farther = x >= 8 && y >= 8, touches = x == 8 || y == 8;
            EXPECT_EQ(slopes.at(x, y).beside_edge, farther && touches) << x << ' ' << y;
        }
    }
}

TEST_F(MeasureSlopeTest, AgreesWithTheReference) {
    for (const Extent2D extent : kPictureExtents) {
        const Intrinsics camera = pinhole_camera(extent);
        const Image<float> depth_m = random_depth(extent, 17);
        const Image<Slope> got = measure(depth_m, camera), expected = reference::measure_slope(depth_m, camera);
        for (size_t i = 0; i < extent.area(); ++i) {
            const Slope want = reference::rounded(expected.pixels()[i]);
            ASSERT_NEAR(got.pixels()[i].depth_per_px.x, want.depth_per_px.x, 1.01 * kPerPxStep) << i;
            ASSERT_NEAR(got.pixels()[i].depth_per_px.y, want.depth_per_px.y, 1.01 * kPerPxStep) << i;
            ASSERT_NEAR(got.pixels()[i].plane_factor, want.plane_factor, 1.01 * kFactorStep) << i;
            ASSERT_EQ(got.pixels()[i].beside_edge, want.plane_factor > 0 && want.beside_edge) << i;
        }
    }
}

TEST_F(MeasureSlopeTest, AnImageOfAnotherCameraIsAnError) {
    graph::FrameGraph frame = runner().begin();
    const auto depth = frame.create_image("depth_m", {{4, 4}, vulkan::Format::kR32f});
    EXPECT_THAT(
        [&] {
            add_measure_slope(frame, depth, pinhole_camera({8, 8}));
        },
        ::testing::ThrowsMessage<Error>(::testing::HasSubstr("4 x 4 pixels, its camera has 8 x 8")));
}

}  // namespace
}  // namespace patina::measure_slope_test
