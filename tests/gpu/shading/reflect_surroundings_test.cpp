// What glossy points of a wall mirror of a room of known radiance.

#include "passes/shading/reflect_surroundings.h"

#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "passes/reflectance/mark_blocks.h"
#include "passes/state/lights.h"
#include "passes/state/reflectance_state.h"
#include "shared/shading/reflect_surroundings.h"
#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/shading/reflect_surroundings.h"

namespace patina::reflect_surroundings_test {
namespace {

constexpr double kHalf_m = 0.4;
constexpr Extent2D kExtent{8, 4};
constexpr uint32_t kRays = 64;
const glm::dvec3 kEye(0.1, -0.05, -0.2), kWall(0, 0, -1);  // the normal of the wall z = kHalf_m
const glm::dvec3 kIndirect(0.2, 0.3, 0.1), kKs(0.5, 0.4, 0.25), kSeen(0.05, 0.1, 0.15);
const Intrinsics kCamera{{160, 160}, 72, 72, 79.5, 79.5, {}};  // 96 degrees: six views see all around

/// A cube seen from inside; behind the eye one half is bright, the other dim, and the ceiling is red.
double room(glm::dvec3 p) { return -reference::box({0, 0, 0}, glm::dvec3(kHalf_m))(p); }
glm::dvec3 radiance(glm::dvec3 p) {
    if (p.y < -0.98 * kHalf_m) return {0.6, 0.1, 0.05};
    return glm::dvec3(p.x < 0 ? 0.7 : 0.2);
}

/// Where a ray from inside meets the cube.
glm::dvec3 met(glm::dvec3 from, glm::dvec3 direction) {
    double nearest = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(direction[axis]) < 1e-9) continue;
        nearest = std::min(nearest, (std::copysign(kHalf_m, direction[axis]) - from[axis]) / direction[axis]);
    }
    return from + nearest * direction;
}

class ReflectSurroundings : public GpuTest {
  protected:
    ReflectSurroundings() : rig_(device(), runner()) {}

    void fuse(std::span<const glm::dvec3> directions) {
        for (const glm::dvec3 direction : directions) {
            // Never along the axis that look_at() takes for up.
            const RigidTransform pose = reference::look_at({0, 0, 0}, direction + glm::dvec3(0.03, 0.02, 0.03));
            const Image<float> depth_m = reference::render_depth(room, kCamera, pose, 4);
            ColorView color{kCamera, pose, Image<glm::vec4>(kCamera.extent, glm::vec4(0))};
            for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
                for (uint32_t x = 0; x < kCamera.extent.width; ++x) {
                    const glm::dvec3 ray((x - kCamera.cx) / kCamera.fx, (y - kCamera.cy) / kCamera.fy, 1);
                    const glm::dvec3 point(pose * glm::dvec4(ray * double{depth_m.at(x, y)}, 1));
                    color.linear.at(x, y) = glm::vec4(glm::vec3(radiance(point)), 1);
                }
            }
            for (int i = 0; i < 4; ++i) rig_.fuse(kCamera, pose, depth_m, color);
        }
    }

    static glm::dvec3 point(uint32_t x, uint32_t y) { return {-0.28 + 0.08 * x, -0.12 + 0.08 * y, kHalf_m}; }

    /// What pixels show whose points lie on the wall, after they showed kSeen.
    Image<glm::vec4> reflect(glm::dvec3 ks, double alpha, MapAccess access = MapAccess::kStorage) {
        Image<glm::vec4> position_m(kExtent, glm::vec4(0));
        for (uint32_t y = 0; y < kExtent.height; ++y)
            for (uint32_t x = 0; x < kExtent.width; ++x) position_m.at(x, y) = glm::vec4(glm::vec3(point(x, y)), 1);
        const auto halves = [](glm::dvec3 rgb, double a) {
            const uint64_t packed = glm::packHalf4x16(glm::vec4(glm::vec3(rgb), static_cast<float>(a)));
            return glm::uvec2(static_cast<uint32_t>(packed), static_cast<uint32_t>(packed >> 32));
        };
        const auto filled = [&](glm::dvec3 rgb, double a) {
            return std::vector<glm::uvec2>(kExtent.area(), halves(rgb, a));
        };
        graph::FrameGraph frame = runner().begin();
        const auto upload = [&](const char* name, vulkan::Format format, const auto& pixels) {
            return frame.upload(name, {kExtent, format}, std::as_bytes(std::span(pixels)));
        };
        Lights lights;
        ReflectSurroundingsInputs inputs;
        inputs.position_m = upload("position_m", vulkan::Format::kRgba32f, position_m.pixels());
        inputs.normal = upload("normal", vulkan::Format::kRgba16f, filled(kWall, 0));
        inputs.rgb = upload("rgb", vulkan::Format::kRgba16f, filled(kSeen, 1));
        const std::vector<gpu::GlossyPixel> glossy(kExtent.area(), {halves(ks, alpha), halves(kIndirect, 0)});
        inputs.glossy = frame.upload<gpu::GlossyPixel>("glossy", glossy);
        ReflectanceStateIds state;
        state.surroundings = frame.fill(frame.create_buffer("surroundings", kSurroundingsBytes), 0);
        add_mark_blocks(frame, state, rig_.map(), rig_.map().import(frame));
        inputs.surroundings = state.surroundings;
        inputs.lights = lights.upload(frame);
        inputs.ball_m = glm::vec4(glm::vec3(kEye), 8);
        inputs.rays = kRays;
        inputs.access = access;
        const graph::Readback read =
            frame.read_back(add_reflect_surroundings(frame, rig_.map(), rig_.map().import(frame), inputs));
        run(std::move(frame));
        return widen(read.image<uint64_t>());
    }

    static glm::dvec3 added(const Image<glm::vec4>& seen, uint32_t x, uint32_t y) {
        return (glm::dvec3(seen.at(x, y)) - kSeen) / kKs;
    }

    /// Calls check(x, y, what the reference has arriving) for each pixel.
    template <class Check>
    static void compare(double alpha, const std::function<glm::dvec3(glm::dvec3, glm::dvec3)>& arrives,
                        const Check& check) {
        for (uint32_t y = 0; y < kExtent.height; ++y) {
            for (uint32_t x = 0; x < kExtent.width; ++x) {
                const glm::dvec3 from = point(x, y);
                const auto along = [&](glm::dvec3 direction) { return arrives(from, direction); };
                check(x, y, reference::mirrored(along, kWall, glm::normalize(kEye - from), alpha, 200));
            }
        }
    }

    static constexpr std::array<glm::dvec3, 6> kAll{glm::dvec3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0},
                                                    {0, -1, 0},          {0, 0, 1},  {0, 0, -1}};
    FusionRig rig_;
};

glm::dvec3 of_room(glm::dvec3 from, glm::dvec3 direction) { return radiance(met(from, direction)); }

TEST_F(ReflectSurroundings, AGlossyWallMirrorsTheRoom) {
    fuse(kAll);
    for (const double alpha : {0.02, 0.1, 0.3}) {
        const Image<glm::vec4> seen = reflect(kKs, alpha);
        double squares = 0, spread = 0;
        compare(alpha, of_room, [&](uint32_t x, uint32_t y, glm::dvec3 expected) {
            const glm::dvec3 off = added(seen, x, y) - expected;
            squares += off.r * off.r / kExtent.area();
            spread += std::abs(expected.r - 0.45) / kExtent.area();
        });
        // Where a lobe is cut in two, half its rays bring 0.5 more: 0.25 / sqrt(64) is 0.03, and strata halve it. A
        // sharp one meets the border between two colours, which is a voxel wide.
        EXPECT_LT(std::sqrt(squares), 0.03) << alpha;
        EXPECT_GT(spread, 0.08) << "the picture is not even";
    }
}

// A thousand rays, of which none errs in one direction.
TEST_F(ReflectSurroundings, ItsMeanIsThatOfTheReference) {
    fuse(kAll);
    const Image<glm::vec4> seen = reflect(kKs, 0.2);
    glm::dvec3 bias(0);
    compare(0.2, of_room, [&](uint32_t x, uint32_t y, glm::dvec3 expected) {
        bias += (added(seen, x, y) - expected) / double(kExtent.area());
    });
    for (int c = 0; c < 3; ++c) EXPECT_LT(std::abs(bias[c]), 0.01) << c;
}

TEST_F(ReflectSurroundings, BothWaysToReadTheMapShowTheSame) {
    fuse(kAll);
    if (preferred_map_access(device().caps(), rig_.map()) != MapAccess::kTexel) GTEST_SKIP() << "storage alone";
    EXPECT_EQ(reflect(kKs, 0.1).pixels(), reflect(kKs, 0.1, MapAccess::kTexel).pixels());
}

TEST_F(ReflectSurroundings, WhereRaysMeetNothingKnownTheGatheredLightArrives) {
    const std::array<glm::dvec3, 1> own_wall{glm::dvec3(0, 0, 1)};
    fuse(own_wall);
    const Image<glm::vec4> seen = reflect(kKs, 0.05);
    const auto even = [](glm::dvec3, glm::dvec3) { return kIndirect; };
    compare(0.05, even, [&](uint32_t x, uint32_t y, glm::dvec3 expected) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(added(seen, x, y)[c], expected[c], 0.01) << x << ' ' << y << ' ' << c;
    });
}

TEST_F(ReflectSurroundings, WithHardlyAnyGlossTheGatheredLightIsEnough) {
    fuse(kAll);
    const glm::dvec3 little(0.05, 0.04, 0.02);
    const Image<glm::vec4> seen = reflect(little, 0.05);
    for (const glm::vec4& pixel : seen.pixels()) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], kSeen[c] + little[c] * kIndirect[c], 2e-4) << c;
        EXPECT_EQ(pixel.a, 1.0f);
    }
}

}  // namespace
}  // namespace patina::reflect_surroundings_test
