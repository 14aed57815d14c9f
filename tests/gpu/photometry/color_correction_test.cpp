#include "reconstruction/stages/color_correction.h"

#include <cmath>

#include "reconstruction/pipeline.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/scenes/analytic_scene.h"

namespace patina::color_correction_test {
namespace {

constexpr uint32_t kFrames = 8;
const Intrinsics kCamera{{160, 120}, 150, 150, 79.5, 59.5, {}};

/// What automatic exposure and white balance do to frame `index`.
glm::vec3 true_gain(uint32_t index) {
    const auto i = static_cast<float>(index);
    return {1 + 0.06f * i, 1 - 0.03f * i, 1 + 0.2f * std::sin(i)};
}

/// The painted surface's colour at a point, for the first frame's exposure.
glm::vec3 paint(glm::dvec3 at_m) {
    return {0.2 + 0.1 * std::sin(9 * at_m.x), 0.25 + 0.1 * std::cos(7 * at_m.y), 0.15 + 0.1 * std::sin(8 * at_m.y)};
}

/// A camera with automatic exposure and white balance moves along a painted wall with a ball before it, whose highlight
/// follows the camera.
class ColorCorrectionTest : public GpuTest {
  protected:
    struct Picture {
        RigidTransform pose;
        Image<float> depth_m;
        Image<glm::vec3> color;

        RgbdFrame frame() const {
            RgbdFrame rgbd;
            rgbd.depth.pixels = std::span(depth_m.pixels());
            rgbd.color.pixels = std::span(color.pixels());
            rgbd.depth.camera = rgbd.color.camera = kCamera;
            rgbd.world_from_depth = pose;
            return rgbd;
        }
    };

    static Picture picture(uint32_t index) {
        const auto wall = reference::half_space({0, 0, -1}, -2.0);
        const auto ball = reference::sphere({0.3, 0.1, 1.5}, 0.25);
        const auto field = [=](glm::dvec3 p) { return std::min(wall(p), ball(p)); };
        const RigidTransform pose = reference::look_at({-0.3 + 0.05 * index, 0.02 * index, 0}, {0, 0, 2});
        Picture made{pose, reference::render_depth(field, kCamera, pose, 5), Image<glm::vec3>(kCamera.extent)};
        for (uint32_t y = 0; y < kCamera.extent.height; ++y) {
            for (uint32_t x = 0; x < kCamera.extent.width; ++x) {
                const glm::dvec3 ray((x - kCamera.cx) / kCamera.fx, (y - kCamera.cy) / kCamera.fy, 1);
                const glm::dvec3 at_m(pose * glm::dvec4(ray * double{made.depth_m.at(x, y)}, 1));
                const bool highlight = glm::length(glm::dvec2(ray) - glm::dvec2(0.2, 0.1)) < 0.1;
                made.color.at(x, y) = true_gain(index) * (highlight ? glm::vec3(0.5f) : paint(at_m));
            }
        }
        return made;
    }

    static ReconstructionSettings settings() {
        ReconstructionSettings settings;
        settings.map.voxel_m = 0.02f;
        settings.map.capacity_blocks = 4096;
        settings.fusion.truncation_m = 0.06f;
        settings.gains.emplace();
        return settings;
    }

    static void expect_true(const gpu::ColorGains& got, uint32_t index) {
        for (glm::length_t c = 0; c < 3; ++c) {
            const float expected = true_gain(index)[c];  // 1 for the first frame
            EXPECT_NEAR(got.gain[c], expected, 0.02 * expected) << "frame " << index << ", channel " << c;
        }
    }
};

TEST_F(ColorCorrectionTest, GainsOfASequenceComeBackRelativeToItsFirstFrame) {
    Pipeline pipeline(device(), settings());
    for (uint32_t i = 0; i < kFrames; ++i) pipeline.add(picture(i).frame());
    const graph::CompiledFrame& compiled = pipeline.runner().last_frame();
    EXPECT_THAT(graph::check(compiled.description, compiled.plan), ::testing::IsEmpty());
    EXPECT_THAT(graph::find_unneeded_barriers(compiled.description, compiled.plan), ::testing::IsEmpty());
    pipeline.wait();
    ASSERT_EQ(pipeline.gains().size(), kFrames);
    EXPECT_EQ(glm::vec3(pipeline.gains()[0].gain), glm::vec3(1));
    EXPECT_EQ(pipeline.gains()[0].samples, glm::uvec4(0)) << "nothing was seen before the first frame";
    for (uint32_t i = 1; i < kFrames; ++i) {
        EXPECT_GT(pipeline.gains()[i].samples.g, 500u);
        expect_true(pipeline.gains()[i], i);
    }
}

TEST_F(ColorCorrectionTest, AHeldOutFrameHasAGainAndLeavesNoColour) {
    Pipeline pipeline(device(), settings());
    const Picture picture_0 = picture(0), picture_3 = picture(3);
    RgbdFrame first = picture_0.frame();
    pipeline.add(first);
    const auto look = [&] {
        const ViewReadback pending = pipeline.view(kCamera, first.world_from_depth);
        pipeline.wait();
        return pending.get().color;
    };
    const Image<glm::vec4> before = look();
    const Image<glm::u8vec3> white(kCamera.extent, glm::u8vec3(255));
    first.color.pixels = std::span(white.pixels());
    first.held_out = true;
    pipeline.add(first);
    EXPECT_EQ(look().pixels()[before.pixels().size() / 2], before.pixels()[before.pixels().size() / 2]);
    RgbdFrame second = picture_3.frame();
    second.held_out = true;
    pipeline.add(second);
    pipeline.wait();
    ASSERT_EQ(pipeline.gains().size(), 3u);
    EXPECT_EQ(glm::vec3(pipeline.gains()[1].gain), glm::vec3(1)) << "all its pixels are clipped";
    expect_true(pipeline.gains()[2], 3);
}

TEST_F(ColorCorrectionTest, GainsWithoutFusedColourAreRefused) {
    ReconstructionSettings without_color = settings();
    without_color.fusion.color = false;
    EXPECT_THAT([&] { Pipeline(device(), without_color); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("fusion.color is false")));
}

}  // namespace
}  // namespace patina::color_correction_test
