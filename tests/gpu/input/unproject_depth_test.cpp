#include "passes/input/unproject_depth.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/reference/input/unproject_depth.h"

namespace patina::unproject_depth_test {
namespace {

/// Half floats round a component of a unit vector by at most 2^-11, or 2^-10 where the device rounds towards zero.
constexpr float kNormalTolerance = 1.1e-3f;
/// Single precision a few metres from the origin.
constexpr float kPositionTolerance_m = 3e-6f;

RigidTransform test_pose() {
    RigidTransform pose = glm::rotate(glm::dmat4(1), 0.8, glm::normalize(glm::dvec3(1, -2, 0.5)));
    pose[3] = {1.5, -0.7, 2.0, 1};
    return pose;
}

class UnprojectDepthTest : public GpuTest {
  protected:
    reference::Surface unproject(const Image<float>& depth_m, const Intrinsics& camera) {
        graph::FrameGraph frame = runner().begin();
        const auto id = frame.upload("depth_m", {depth_m.extent(), vulkan::Format::kR32f},
                                     std::as_bytes(std::span(depth_m.pixels())));
        const UnprojectedDepth surface = add_unproject_depth(frame, id, make_camera(camera, test_pose()));
        const graph::Readback position_m = frame.read_back(surface.position_m);
        const graph::Readback normal = frame.read_back(surface.normal);
        run(std::move(frame));
        std::vector<glm::vec4> normals;
        for (const uint64_t halves : normal.as<uint64_t>()) normals.push_back(glm::unpackHalf4x16(halves));
        return {position_m.image<glm::vec4>(), Image<glm::vec4>(depth_m.extent(), normals)};
    }

    std::vector<reference::Surface> unproject_both(const Image<float>& depth_m, const Intrinsics& camera) {
        return {unproject(depth_m, camera), reference::unproject_depth(depth_m, camera, test_pose(), {})};
    }
};

TEST_F(UnprojectDepthTest, ATiltedPlaneHasItsPositionsAndItsNormal) {
    const Intrinsics camera = pinhole_camera({65, 33});
    const glm::dvec3 plane_normal = glm::normalize(glm::dvec3(0.3, -0.4, -1));  // camera coordinates
    const double offset_m = 1.8;                                                // n . p = -offset
    Image<float> depth_m(camera.extent);
    const auto ray = [&](uint32_t x, uint32_t y) {
        return glm::dvec3((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
    };
    for (uint32_t y = 0; y < 33; ++y) {
        for (uint32_t x = 0; x < 65; ++x) {
            depth_m.at(x, y) = static_cast<float>(-offset_m / glm::dot(plane_normal, ray(x, y)));
        }
    }
    const glm::vec4 world_normal(test_pose() * glm::dvec4(plane_normal, 0));
    for (const auto& surface : unproject_both(depth_m, camera)) {
        for (uint32_t y = 0; y < 33; ++y) {
            for (uint32_t x = 0; x < 65; ++x) {
                const double z = depth_m.at(x, y);
                const glm::vec4 expected(test_pose() * glm::dvec4(ray(x, y) * z, 1));
                EXPECT_LT(glm::distance(surface.position_m.at(x, y), expected), kPositionTolerance_m);
                const bool border = x == 0 || y == 0 || x == 64 || y == 32;
                EXPECT_LT(glm::distance(surface.normal.at(x, y), border ? glm::vec4(0) : world_normal),
                          border ? 1e-30f : kNormalTolerance)
                    << x << ' ' << y;
            }
        }
    }
}

TEST_F(UnprojectDepthTest, HolesAndStepsHaveNoNormals) {
    const Intrinsics camera = pinhole_camera({20, 9});
    Image<float> depth_m(camera.extent, 1.0f);
    depth_m.at(4, 4) = 0;
    for (uint32_t y = 0; y < 9; ++y) {
        // At 1 m neighbours may differ by 0.04 m; seen from 1.05 m, by 0.0415 m.
        for (uint32_t x = 10; x < 15; ++x) depth_m.at(x, y) = 1.05f;
        for (uint32_t x = 15; x < 20; ++x) depth_m.at(x, y) = 1.085f;
    }
    for (const auto& surface : unproject_both(depth_m, camera)) {
        for (uint32_t y = 0; y < 9; ++y) {
            for (uint32_t x = 0; x < 20; ++x) {
                const bool hole = x == 4 && y == 4;
                EXPECT_EQ(surface.position_m.at(x, y).w, hole ? 0.0f : 1.0f);
                EXPECT_EQ(surface.position_m.at(x, y) == glm::vec4(0), hole);
                const bool border = x == 0 || y == 0 || x == 19 || y == 8;
                const bool beside_hole = (x == 4 && y >= 3 && y <= 5) || (y == 4 && x >= 3 && x <= 5);
                const bool beside_step = x == 9 || x == 10;
                const float length = glm::length(surface.normal.at(x, y));
                EXPECT_NEAR(length, border || beside_hole || beside_step ? 0 : 1, kNormalTolerance) << x << ' ' << y;
            }
        }
    }
}

TEST_F(UnprojectDepthTest, NormalsFaceTheCameraOnAnySurface) {
    const Intrinsics camera = pinhole_camera({65, 33});
    const glm::vec3 center(test_pose()[3]);
    int normals = 0;
    for (const auto& surface : unproject_both(random_depth(camera.extent, 2), camera)) {
        for (size_t i = 0; i < camera.extent.area(); ++i) {
            const glm::vec3 normal(surface.normal.pixels()[i]);
            if (normal == glm::vec3(0)) continue;
            EXPECT_LT(glm::dot(normal, glm::vec3(surface.position_m.pixels()[i]) - center), 0);
            ++normals;
        }
    }
    EXPECT_GT(normals, 100);
}

TEST_F(UnprojectDepthTest, AgreesWithTheReference) {
    for (const Extent2D extent : kPictureExtents) {
        const Intrinsics camera = pinhole_camera(extent);
        const Image<float> depth_m = random_depth(extent, 23);
        const reference::Surface got = unproject(depth_m, camera);
        const reference::Surface expected = reference::unproject_depth(depth_m, camera, test_pose(), {});
        for (size_t i = 0; i < extent.area(); ++i) {
            ASSERT_LT(glm::distance(got.position_m.pixels()[i], expected.position_m.pixels()[i]), kPositionTolerance_m);
            ASSERT_LT(glm::distance(got.normal.pixels()[i], expected.normal.pixels()[i]), kNormalTolerance);
        }
    }
}

TEST_F(UnprojectDepthTest, AnotherExtentThanTheCamerasIsAnError) {
    graph::FrameGraph frame = runner().begin();
    const auto id = frame.create_image("depth_m", {{4, 5}, vulkan::Format::kR32f});
    EXPECT_THAT(
        [&] {
            add_unproject_depth(frame, id, make_camera(pinhole_camera({5, 4}), test_pose()));
        },
        ::testing::ThrowsMessage<Error>(
            "the pass 'input.unproject_depth' got a depth image of 4 x 5 from a camera of 5 x 4"));
}

}  // namespace
}  // namespace patina::unproject_depth_test
