#include "passes/color_correction.h"

#include <cmath>

#include "passes/reconstruction.h"
#include "sensor/synthetic/scene_file.h"
#include "sensor/synthetic/synthetic_source.h"
#include "tests/gpu/gpu_test.h"
#include "tools/export/drawing.h"
#include "tools/rgbd_frame.h"

namespace patina {
namespace {

constexpr uint32_t kFrames = 8;

/// What automatic exposure and white balance do to frame `index`.
glm::vec3 true_gain(uint32_t index) {
    const auto i = static_cast<float>(index);
    return {1 + 0.06f * i, 1 - 0.03f * i, 1 + 0.2f * std::sin(i)};
}

/// A camera with automatic exposure and white balance moves through a scene with shadows and highlights.
class ColorCorrectionTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        sensor::Scene scene = sensor::load_scene("cubes");
        scene.camera = scaled_to(scene.camera, {256, 212});
        sensor::SyntheticSource source(device(), std::move(scene), {.frames = 10 * kFrames});
        info_ = source.info();
        for (uint32_t i = 0; i < kFrames; ++i) frames_.push_back(std::get<sensor::Frame>(*source.next()));
        for (uint32_t i = 0; i < kFrames; ++i) {
            for (sensor::SrgbPixel& pixel : std::get<Image<sensor::SrgbPixel>>(frames_[i].color).pixels())
                pixel = color_pixel(linear_color(pixel) * true_gain(i));
        }
    }

    ReconstructionSettings settings() const {
        ReconstructionSettings settings;
        settings.map.voxel_m = 0.02f;
        settings.map.capacity_blocks = 4096;
        settings.fusion.truncation_m = 0.06f;
        settings.gains.emplace();
        return settings;
    }

    RgbdFrame frame(uint32_t index) const { return tools::to_rgbd(info_, frames_[index]); }

    static void expect_true(const gpu::ColorGains& got, uint32_t index) {
        for (glm::length_t c = 0; c < 3; ++c) {
            const float expected = true_gain(index)[c] / true_gain(0)[c];
            EXPECT_NEAR(got.gain[c], expected, 0.02 * expected) << "frame " << index << ", channel " << c;
        }
    }

    sensor::SequenceInfo info_;
    std::vector<sensor::Frame> frames_;
};

TEST_F(ColorCorrectionTest, GainsOfASequenceComeBackRelativeToItsFirstFrame) {
    Reconstruction reconstruction(device(), settings());
    for (uint32_t i = 0; i < kFrames; ++i) reconstruction.add(frame(i));
    const graph::CompiledFrame& compiled = reconstruction.runner().last_frame();
    EXPECT_THAT(graph::check(compiled.description, compiled.plan), ::testing::IsEmpty());
    EXPECT_THAT(graph::find_unneeded_barriers(compiled.description, compiled.plan), ::testing::IsEmpty());
    reconstruction.wait();
    ASSERT_EQ(reconstruction.gains().size(), kFrames);
    EXPECT_EQ(glm::vec3(reconstruction.gains()[0].gain), glm::vec3(1));
    EXPECT_EQ(reconstruction.gains()[0].samples, glm::uvec4(0)) << "nothing was seen before the first frame";
    for (uint32_t i = 1; i < kFrames; ++i) {
        EXPECT_GT(reconstruction.gains()[i].samples.g, 500u);
        expect_true(reconstruction.gains()[i], i);
    }
}

TEST_F(ColorCorrectionTest, AHeldOutFrameHasAGainAndLeavesNoColour) {
    Reconstruction reconstruction(device(), settings());
    RgbdFrame first = frame(0);
    reconstruction.add(first);
    const auto look = [&] {
        const PendingView pending = reconstruction.view(info_.color, first.world_from_depth);
        reconstruction.wait();
        return pending.get().color;
    };
    const Image<glm::vec4> before = look();
    const Image<sensor::SrgbPixel> white(info_.color.extent, sensor::SrgbPixel(255));
    first.color.pixels = std::span(white.pixels());
    first.held_out = true;
    reconstruction.add(first);
    EXPECT_EQ(look().pixels()[before.pixels().size() / 2], before.pixels()[before.pixels().size() / 2]);
    RgbdFrame second = frame(3);
    second.held_out = true;
    reconstruction.add(second);
    reconstruction.wait();
    ASSERT_EQ(reconstruction.gains().size(), 3u);
    EXPECT_EQ(glm::vec3(reconstruction.gains()[1].gain), glm::vec3(1)) << "all its pixels are clipped";
    expect_true(reconstruction.gains()[2], 3);
}

TEST_F(ColorCorrectionTest, GainsWithoutFusedColourAreRefused) {
    ReconstructionSettings without_color = settings();
    without_color.fusion.color = false;
    EXPECT_THAT([&] { Reconstruction(device(), without_color); },
                ::testing::ThrowsMessage<Error>(::testing::HasSubstr("fusion.color is false")));
}

}  // namespace
}  // namespace patina
