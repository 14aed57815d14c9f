#include "passes/fusion/shade_color.h"

#include <cmath>

#include <glm/gtc/packing.hpp>

#include "engine/core/shader_camera.h"
#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/fusion/shade_color.h"

namespace patina::shade_color_test {
namespace {

const Intrinsics kCamera{{160, 120}, 150, 150, 79.5, 59.5, {}};
const RigidTransform kPose{1.0};
constexpr double kWallM = 1.0;

class ShadeColorTest : public GpuTest {
  protected:
    struct Shaded {
        Image<glm::vec4> position_m;
        std::vector<glm::vec4> color;
    };

    Shaded shade(FusionRig& rig, const Intrinsics& camera) {
        graph::FrameGraph frame = runner().begin();
        const VoxelMapIds ids = rig.map().import(frame);
        const VisibleBlocks visible = add_visible_blocks(frame, rig.map(), ids, make_camera(camera, kPose), 0.1f, 3.0f);
        const RaycastImages model = add_raycast(frame, rig.map(), ids, visible, MapAccess::kStorage);
        const graph::ImageId shaded = add_shade_color(frame, rig.map(), ids, visible, model.position_m);
        const graph::Readback position = frame.read_back(model.position_m), color = frame.read_back(shaded);
        run(std::move(frame));
        Shaded result{position.image<glm::vec4>(), {}};
        for (const uint64_t halves : color.as<uint64_t>()) result.color.push_back(glm::unpackHalf4x16(halves));
        return result;
    }

    /// A wall that faces the camera, painted left and right of the image's middle.
    FusionRig wall(glm::vec3 left, glm::vec3 right, float right_alpha = 1) {
        FusionRig rig(device(), runner());
        Image<glm::vec4> color(kCamera.extent);
        for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
            for (uint32_t x = 0; x < kCamera.extent.width; ++x) {
                color.at(x, y) = x < kCamera.extent.width / 2 ? glm::vec4(left, 1) : glm::vec4(right, right_alpha);
            }
        }
        // Several frames, so that every block is allocated and rounding by chance evens out.
        for (int i = 0; i < 8; ++i) {
            rig.fuse(kCamera, kPose, Image<float>(kCamera.extent, static_cast<float>(kWallM)),
                     ColorView{kCamera, kPose, color});
        }
        return rig;
    }
};

TEST_F(ShadeColorTest, AWallOfOneColourHasThatColour) {
    const glm::vec3 paint(0.5f, 0.2f, 0.05f);
    FusionRig rig = wall(paint, paint);
    const Shaded shaded = shade(rig, kCamera);
    for (uint32_t y = 8; y < 112; ++y) {
        for (uint32_t x = 8; x < 152; ++x) {
            const glm::vec4 got = shaded.color[y * kCamera.extent.width + x];
            ASSERT_EQ(got.a, 1.0f) << x << ' ' << y;
            // Steps of the stored root are 2 / 1023 in blue: 2 sqrt(0.05) 2 / 1023 is below 0.001.
            for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[c], paint[c], 0.004f) << x << ' ' << y;
        }
    }
}

TEST_F(ShadeColorTest, AgreesWithTheReferenceOnTheSameVoxels) {
    FusionRig rig = wall({0.8f, 0.1f, 0.1f}, {0.1f, 0.2f, 0.9f});
    const reference::Volume volume = rig.volume();
    for (const Extent2D extent : {Extent2D{1, 1}, {13, 7}, {65, 33}}) {
        const double focal = 0.9 * extent.width;
        const Intrinsics camera{extent, focal, focal, 0.5 * (extent.width - 1.0), 0.5 * (extent.height - 1.0), {}};
        const Shaded shaded = shade(rig, camera);
        size_t compared = 0;
        for (size_t i = 0; i < extent.area(); ++i) {
            const glm::vec4 point = shaded.position_m.pixels()[i];
            if (point.w == 0) {
                EXPECT_EQ(shaded.color[i], glm::vec4(0));
                continue;
            }
            const glm::dvec4 expected = reference::color_at(volume, glm::dvec3(point));
            EXPECT_EQ(shaded.color[i].a, expected.a);
            // Half floats round at 2^-11; shares of interpolation are off by the float position's rounding.
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(shaded.color[i][c], expected[c], 1e-3) << extent << ' ' << i;
            ++compared;
        }
        EXPECT_GT(compared, extent.area() / 2);
    }
}

TEST_F(ShadeColorTest, WhatNoColourCameraSawHasNone) {
    FusionRig rig = wall({0.8f, 0.1f, 0.1f}, {0, 0, 0}, 0);
    const Shaded shaded = shade(rig, kCamera);
    const size_t row = 60 * kCamera.extent.width;
    EXPECT_GT(shaded.position_m.pixels()[row + 120].w, 0) << "the wall is there";
    EXPECT_EQ(shaded.color[row + 120], glm::vec4(0));
    EXPECT_EQ(shaded.color[row + 40].a, 1);
}

}  // namespace
}  // namespace patina::shade_color_test
