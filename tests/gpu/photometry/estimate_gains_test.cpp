#include "passes/photometry/estimate_gains.h"

#include <cmath>
#include <random>

#include <glm/gtc/packing.hpp>

#include "shared/input/convert_color.h"
#include "tests/gpu/fusion/fusion_rig.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/photometry/estimate_gains.h"

namespace patina::estimate_gains_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr Extent2D kCast{80, 60};
constexpr double kWallM = 2;
const glm::vec3 kGains(1.3f, 0.9f, 0.6f);

/// Tones between 0.1 and 0.4 that change over the wall, and differ between channels.
glm::vec3 tone(double x, double y) {
    return {0.25 + 0.15 * std::sin(x / 9), 0.25 + 0.15 * std::cos(y / 7), 0.25 + 0.15 * std::sin((x + y) / 8)};
}

/// A wall that faces the camera, as the model has it, and a picture of it `reduction` times as fine whose colours are
/// the model's times `gains`.
reference::ComparedColors wall(Extent2D cast, uint32_t reduction, glm::vec3 gains) {
    reference::ComparedColors frame;
    frame.position_m = frame.normal = frame.model_color = Image<glm::vec4>(cast);
    frame.color = Image<glm::vec4>({cast.width * reduction, cast.height * reduction});
    for (uint32_t y = 0; y < cast.height; ++y) {
        for (uint32_t x = 0; x < cast.width; ++x) {
            frame.position_m.at(x, y) = glm::vec4(kWallM * (x - 40.0) / 70, kWallM * (y - 30.0) / 70, kWallM, kWallM);
            frame.normal.at(x, y) = {0, 0, -1, 0};
            frame.model_color.at(x, y) = glm::vec4(tone(x, y), 1);
        }
    }
    for (uint32_t y = 0; y < frame.color.extent().height; ++y) {
        for (uint32_t x = 0; x < frame.color.extent().width; ++x) {
            const double scale = reduction;
            frame.color.at(x, y) = glm::vec4(gains * tone((x + 0.5) / scale - 0.5, (y + 0.5) / scale - 0.5), 1);
        }
    }
    return frame;
}

GainSettings without_leak() {
    GainSettings settings;
    settings.leak = 0;
    return settings;
}

class EstimateGains : public GpuTest {
  protected:
    graph::ImageId upload(graph::FrameGraph& frame, const std::string& name, const Image<glm::vec4>& image) {
        std::vector<uint64_t> halves;
        for (const glm::vec4& pixel : image.pixels()) halves.push_back(glm::packHalf4x16(pixel));
        return frame.upload(name, {image.extent(), vulkan::Format::kRgba16f}, std::as_bytes(std::span(halves)));
    }

    gpu::ColorGains estimate(const reference::ComparedColors& colors, glm::vec3 before = glm::vec3(1),
                             const GainSettings& settings = without_leak()) {
        graph::FrameGraph frame = runner().begin();
        GainInputs inputs;
        inputs.position_m = frame.upload("position", {colors.position_m.extent(), vulkan::Format::kRgba32f},
                                         std::as_bytes(std::span(colors.position_m.pixels())));
        inputs.normal = upload(frame, "normal", colors.normal);
        inputs.model_color = upload(frame, "model", colors.model_color);
        inputs.color_linear = upload(frame, "color", colors.color);
        inputs.camera_m = glm::vec3(colors.camera_m);
        const gpu::ColorGains last{glm::vec4(before, 1), {}};
        const auto gains = frame.upload<gpu::ColorGains>("gains", std::span(&last, 1));
        const graph::Readback read = frame.read_back(add_estimate_gains(frame, inputs, gains, settings));
        run(std::move(frame));
        return read.as<gpu::ColorGains>().front();
    }

    static void expect_gains(const gpu::ColorGains& got, glm::vec3 expected, double relative) {
        for (glm::length_t c = 0; c < 3; ++c)
            EXPECT_NEAR(got.gain[c], expected[c], relative * expected[c]) << "channel " << c;
    }
};

TEST_F(EstimateGains, KnownGainsComeBackAtEveryResolutionOfTheCast) {
    for (const uint32_t reduction : {1u, 2u, 4u}) {
        const gpu::ColorGains got = estimate(wall(kCast, reduction, kGains));
        expect_gains(got, kGains, 0.003);  // half floats, and a bin of 0.5 %
        EXPECT_GT(got.samples.r, kCast.area() * 8 / 10);
    }
}

TEST_F(EstimateGains, AMinorityOfHighlightsAndChangedSurfacesDoesNotMatter) {
    reference::ComparedColors colors = wall(kCast, 1, kGains);
    for (uint32_t y = 0; y < kCast.height; ++y) {
        for (uint32_t x = 0; x < kCast.width; ++x) {
            if (x < 20) colors.color.at(x, y) *= glm::vec4(1.5, 1.5, 1.5, 1);  // a quarter
            if (x >= 20 && x < 28) colors.color.at(x, y) = {0.05, 0.1, 0.05, 1};
        }
    }
    expect_gains(estimate(colors), kGains, 0.01);
}

TEST_F(EstimateGains, ClippedDarkGrazingAndEdgePixelsStayOut) {
    const reference::ComparedColors clean = wall(kCast, 1, kGains);
    const uint32_t all = estimate(clean).samples.g;
    const auto spoil = [&](auto&& change) {
        reference::ComparedColors colors = clean;
        for (uint32_t y = 0; y < kCast.height; ++y) {
            for (uint32_t x = 0; x < 60; ++x) {  // most of the picture
                colors.color.at(x, y) = glm::vec4(1.2f * kGains * tone(x, y), 1);
                change(colors, x, y);
            }
        }
        const gpu::ColorGains got = estimate(colors);
        expect_gains(got, kGains, 0.003);
        EXPECT_LT(got.samples.g, all / 3);
    };
    spoil([](auto& colors, uint32_t x, uint32_t y) { colors.color.at(x, y).a = gpu::kColorClipped; });
    spoil([](auto& colors, uint32_t x, uint32_t y) { colors.model_color.at(x, y) = glm::vec4(0.01, 0.01, 0.01, 1); });
    spoil([](auto& colors, uint32_t x, uint32_t y) { colors.model_color.at(x, y).a = 0; });
    spoil([](auto& colors, uint32_t x, uint32_t y) { colors.normal.at(x, y) = {1, 0, 0, 0}; });
    spoil([](auto& colors, uint32_t x, uint32_t y) { colors.position_m.at(x, y).z += (x + y) % 2 ? 0.2f : 0.0f; });
    spoil([](auto& colors, uint32_t x, uint32_t y) { colors.position_m.at(x, y).w = 0; });
    spoil([](auto& colors, uint32_t x, uint32_t y) { colors.color.at(x, y) *= (x + y) % 2 ? 1.5f : 1.0f; });
}

TEST_F(EstimateGains, WithoutOverlapTheGainsOfTheFrameBeforeStay) {
    reference::ComparedColors colors = wall(kCast, 1, kGains);
    for (glm::vec4& point : colors.position_m.pixels()) point.w = 0;
    const gpu::ColorGains got = estimate(colors, {1.1f, 0.7f, 2.0f});
    expect_gains(got, {1.1f, 0.7f, 2.0f}, 0);
    EXPECT_EQ(got.samples, glm::uvec4(0));
    GainSettings settings = without_leak();
    settings.min_samples = static_cast<uint32_t>(kCast.area()) + 1;
    expect_gains(estimate(wall(kCast, 1, kGains), {1.1f, 0.7f, 2.0f}, settings), {1.1f, 0.7f, 2.0f}, 0);
}

TEST_F(EstimateGains, TheLeakTakesItsShareOfTheLogarithm) {
    GainSettings settings = without_leak();
    settings.leak = 0.1f;
    expect_gains(estimate(wall(kCast, 1, kGains), glm::vec3(1), settings), glm::pow(kGains, glm::vec3(0.9f)), 0.003);
}

TEST_F(EstimateGains, AgreesWithTheReferenceOnNoisyPictures) {
    std::mt19937 random(7);
    std::lognormal_distribution<float> noise(0, 0.15f);
    for (const Extent2D cast : {Extent2D{1, 1}, {33, 5}, {13, 37}, {80, 60}}) {
        reference::ComparedColors colors = wall(cast, 2, {1.1f, 0.5f, 1.7f});
        for (glm::vec4& pixel : colors.model_color.pixels()) pixel *= glm::vec4(noise(random), noise(random), 1, 1);
        const gpu::ColorGains got = estimate(colors, glm::vec3(1));
        const auto expected = reference::estimate_gains(colors, glm::dvec3(1), GainSettings{}.max_angle_degrees,
                                                        GainSettings{}.min_samples);
        for (glm::length_t c = 0; c < 3; ++c) {
            const reference::ChannelGain& channel = expected[static_cast<size_t>(c)];
            // Bins of 0.5 %; half floats move a few samples over the limits.
            EXPECT_NEAR(got.gain[c], channel.gain, 0.004 * channel.gain) << cast << ", channel " << c;
            EXPECT_NEAR(got.samples[c], channel.samples, 0.01 * static_cast<double>(channel.samples));
        }
    }
}

TEST_F(EstimateGains, SettingsOutOfRangeAreRefused) {
    GainSettings settings = without_leak();
    settings.max_angle_degrees = 120;
    EXPECT_THAT(
        [&] {
            estimate(wall({8, 8}, 1, kGains), glm::vec3(1), settings);
        },
        ThrowsMessage<Error>(HasSubstr("gains.max_angle_degrees is 120, it must be 0 to 90")));
}

TEST_F(EstimateGains, ApplyingThemDividesAndKeepsMarks) {
    const Extent2D extent{13, 7};
    Image<glm::vec4> color(extent, glm::vec4(0.5, 0.25, 1, gpu::kColorValid));
    color.at(1, 0) = {1, 0.5, 1, gpu::kColorClipped};
    color.at(2, 0) = glm::vec4(0);
    graph::FrameGraph frame = runner().begin();
    const gpu::ColorGains gains{{2, 0.5, 0.8f, 0}, {}};
    const graph::ImageId applied = add_apply_gains(frame, upload(frame, "color", color),
                                                   frame.upload<gpu::ColorGains>("gains", std::span(&gains, 1)));
    const graph::Readback read = frame.read_back(applied);
    run(std::move(frame));
    const Image<glm::vec4> got = widen(read.image<uint64_t>());
    const auto near = [](glm::vec4 a, glm::vec4 b) { return glm::distance(a, b) < 2e-3f; };  // half floats
    EXPECT_TRUE(near(got.at(12, 6), {0.25, 0.5, 1.25, gpu::kColorValid}));
    EXPECT_TRUE(near(got.at(1, 0), {1, 1, 1.25, gpu::kColorClipped})) << "clipped red stays at 1";
    EXPECT_EQ(got.at(2, 0), glm::vec4(0));
}

}  // namespace
}  // namespace patina::estimate_gains_test
