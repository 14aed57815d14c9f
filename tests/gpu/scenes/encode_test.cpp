#include "scenes/render/encode.h"

#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "scenes/description/noise.h"
#include "tests/gpu/gpu_test.h"
#include "tests/reference/scenes/encode.h"

namespace patina::encode_test {
namespace {

using scenes::NoiseKey;
using scenes::SensorNoise;
using vulkan::Format;

class EncodeTest : public GpuTest {
  protected:
    /// Depth in units, and ids above them.
    std::vector<uint32_t> encode_depth(const Image<float>& depth_m, const SensorNoise& noise, const NoiseKey& key = {},
                                       double metres_per_unit = 0.001) {
        graph::FrameGraph frame = runner().begin();
        const Image<uint32_t> ids(depth_m.extent(), 7u);
        scenes::RenderedImages rendered;
        rendered.depth_m = upload(frame, "depth_m", depth_m, Format::kR32f);
        rendered.object_id = upload(frame, "object_id", ids, Format::kR32u);
        const auto result = frame.read_back(scenes::add_encode_depth(frame, rendered, metres_per_unit, noise, key));
        run(std::move(frame));
        return unpadded(result, depth_m.extent());
    }

    Image<glm::vec4> expose(const Image<glm::vec4>& radiance, double exposure, const SensorNoise& noise,
                            const NoiseKey& key = {}) {
        graph::FrameGraph frame = runner().begin();
        const graph::ImageId image = upload(frame, "radiance", radiance, Format::kRgba32f);
        const auto result = frame.read_back(scenes::add_expose_color(frame, image, exposure, noise, key));
        run(std::move(frame));
        return result.image<glm::vec4>();
    }

    std::vector<uint32_t> encode_color(const Image<glm::vec4>& linear) {
        graph::FrameGraph frame = runner().begin();
        const graph::ImageId image = upload(frame, "linear", linear, Format::kRgba32f);
        const auto result = frame.read_back(scenes::add_encode_color(frame, image));
        run(std::move(frame));
        return unpadded(result, linear.extent());
    }

  private:
    static std::vector<uint32_t> unpadded(const graph::Readback& readback, Extent2D extent) {
        std::vector<uint32_t> words = readback.as<uint32_t>();
        words.resize(extent.area());
        return words;
    }

    template <class Pixel>
    static graph::ImageId upload(graph::FrameGraph& frame, const char* name, const Image<Pixel>& image, Format format) {
        return frame.upload(name, {image.extent(), format}, std::as_bytes(std::span(image.pixels())));
    }
};

/// Readings in metres.
std::vector<double> metres(const std::vector<uint32_t>& encoded) {
    std::vector<double> values;
    for (const uint32_t word : encoded) values.push_back(0.001 * (word & 0xffff));
    return values;
}

struct Statistics {
    double mean = 0, sigma = 0;
};

Statistics statistics_of(const std::vector<double>& values) {
    const auto count = static_cast<double>(values.size());
    Statistics s;
    for (const double v : values) s.mean += v / count;
    for (const double v : values) s.sigma += (v - s.mean) * (v - s.mean) / count;
    s.sigma = std::sqrt(s.sigma);
    return s;
}

/// Steps, slopes and holes.
Image<float> rough_depth(Extent2D extent) {
    Image<float> depth_m(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const bool hole = (3 * x + 5 * y) % 11 == 0;
            depth_m.at(x, y) = hole ? 0 : 0.6f + 1.7f * static_cast<float>((x / 3 + y / 5) % 4) + 0.01f * float(x);
        }
    }
    return depth_m;
}

TEST_F(EncodeTest, WithoutNoiseDepthIsRoundedAndIdsAreKept) {
    const Image<float> depth_m({7, 1}, {0.0f, 0.0004f, 0.0006f, 1.2344f, 65.535f, 65.5356f, 1e6f});
    const uint32_t id = 7u << 16;
    EXPECT_THAT(encode_depth(depth_m, {}), ::testing::ElementsAre(id, id, id | 1, id | 1234, id | 65535, id, id));
}

TEST_F(EncodeTest, DepthMatchesTheReferenceOnWholeGroupsAndTails) {
    SensorNoise noise = scenes::noise_preset("kinect1");
    for (const Extent2D extent : {Extent2D{1, 1}, {8, 8}, {13, 7}, {32, 4}, {65, 33}}) {
        const NoiseKey key{0x123456789abcdef, extent.width};
        const Image<float> depth_m = rough_depth(extent);
        const auto got = metres(encode_depth(depth_m, noise, key));
        const auto expected = reference::read_depth_m(depth_m, noise, key);
        for (size_t i = 0; i < got.size(); ++i) {
            // Half a unit of rounding; 0.02 mm for fp32 in logarithm, cosine and sums.
            ASSERT_NEAR(got[i], std::max(0.0, expected.pixels()[i]), 0.00052) << extent << " pixel " << i;
        }
    }
}

TEST_F(EncodeTest, DepthNoiseHasThePresetsSigmaAtEveryDepth) {
    const struct {
        const char* name;
        std::function<double(double)> sigma_m;
    } sensors[] = {{"kinect1", [](double z) { return 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4); }},
                   {"kinect2", [](double z) { return 0.001 + 0.00025 * z * z; }}};
    const Extent2D extent{256, 256};
    const auto count = static_cast<double>(extent.area());
    for (const auto& sensor : sensors) {
        for (const float depth_m : {0.8f, 2.0f, 4.0f, 7.0f}) {
            SCOPED_TRACE(text(sensor.name, " at ", depth_m, " m"));
            const auto readings =
                metres(encode_depth(Image<float>(extent, depth_m), scenes::noise_preset(sensor.name), {3, 5}));
            // Rounding to 1 mm adds a variance of 1 / 12 mm^2.
            const double sigma_m = std::hypot(sensor.sigma_m(depth_m), 0.001 / std::sqrt(12.0));
            const Statistics got = statistics_of(readings);
            EXPECT_NEAR(got.mean, depth_m, 4 * sigma_m / std::sqrt(count));
            EXPECT_NEAR(got.sigma, sigma_m, 4 * sigma_m / std::sqrt(2 * count));
            const double wide = 2.5 * sigma_m;
            double beyond = 0;
            for (const double z : readings) beyond += std::abs(z - depth_m) > wide;
            if (sigma_m < 0.005) continue;  // steps of 1 mm are too coarse to count by
            EXPECT_NEAR(beyond / count, 0.01242, 0.0025) << "tails are a Gaussian's";
        }
    }
}

TEST_F(EncodeTest, PixelsFlyAtEdgesOnlyAndBetweenTheTwoDepths) {
    const Extent2D extent{12, 4000};
    Image<float> depth_m(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            // A step at x = 6; holes at x = 0; beyond x = 8 a slope of 2.9 % per pixel.
            const float slope = 1.0f + 0.029f * static_cast<float>(std::max(x, 8u) - 8u);
            depth_m.at(x, y) = x == 0 ? 0.0f : x < 6 ? 1.0f : 2.0f * slope;
        }
    }
    SensorNoise noise;
    noise.flying_pixels = 0.3;
    const std::vector<double> readings = metres(encode_depth(depth_m, noise, {1, 2}));
    std::vector<double> flying;
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const double z = readings[y * extent.width + x];
            if (std::abs(z - depth_m.at(x, y)) <= 0.0006) continue;
            ASSERT_TRUE(x == 5 || x == 6) << x << ' ' << z;
            flying.push_back(z);
        }
    }
    EXPECT_NEAR(static_cast<double>(flying.size()) / (2 * extent.height), 0.3, 0.02);
    const Statistics got = statistics_of(flying);
    EXPECT_NEAR(got.mean, 1.5, 0.03);
    EXPECT_NEAR(got.sigma, 1 / std::sqrt(12.0), 0.02) << "evenly between";
    for (const double z : flying) ASSERT_TRUE(z >= 1 && z <= 2) << z;
}

TEST_F(EncodeTest, ColorMatchesTheReferenceOnWholeGroupsAndTails) {
    const SensorNoise noise = scenes::noise_preset("kinect2");
    for (const Extent2D extent : {Extent2D{1, 1}, {8, 8}, {13, 7}, {32, 4}, {65, 33}}) {
        Image<glm::vec4> radiance(extent);
        float next = 0;
        for (glm::vec4& pixel : radiance.pixels()) pixel = glm::vec4(next, 0.3f * next, 0.01f * next, 1), next += 0.01f;
        const NoiseKey key{0xfedcba9876543210, extent.height};
        const auto got = expose(radiance, 0.7, noise, key);
        const auto expected = reference::expose_color(radiance, 0.7, noise, key);
        for (size_t i = 0; i < extent.area(); ++i) {
            for (int c = 0; c < 3; ++c) {
                const double e = expected.pixels()[i][c], value = 0.7 * radiance.pixels()[i][c];
                const double sigma = std::sqrt(noise.color_read * noise.color_read + noise.color_shot * value);
                // Vulkan allows sin and cos an error of 2^-11, which Box-Muller multiplies by up to sqrt(2 ln 2^24).
                const double bound = 1e-6 + 1e-5 * e + sigma * 5.8 / 2048;
                EXPECT_NEAR(got.pixels()[i][c], e, bound) << extent << " pixel " << i << " channel " << c;
            }
            ASSERT_EQ(got.pixels()[i].a, 1);
        }
    }
}

TEST_F(EncodeTest, WithoutNoiseColorIsScaledAndNeverClipped) {
    const Image<glm::vec4> radiance({2, 1}, {glm::vec4(0, 0.5f, 80, 1), glm::vec4(0)});
    EXPECT_EQ(expose(radiance, 1, {}).pixels(), radiance.pixels());
    EXPECT_EQ(expose(radiance, 0.25, {}).at(0, 0), glm::vec4(0, 0.125f, 20, 1));
}

TEST_F(EncodeTest, ShotNoiseGrowsWithTheValueAndReadNoiseDoesNot) {
    SensorNoise noise;
    noise.color_read = 0.004;
    noise.color_shot = 0.001;
    const Extent2D extent{256, 256};
    for (const double value : {0.05, 0.2, 0.8, 3.0}) {
        const auto got = expose(Image<glm::vec4>(extent, glm::vec4(static_cast<float>(value / 2))), 2, noise, {9, 0});
        std::array<std::vector<double>, 3> channels;
        double cross = 0;
        for (const glm::vec4& pixel : got.pixels()) {
            for (int c = 0; c < 3; ++c) channels[static_cast<size_t>(c)].push_back(pixel[c]);
            cross += (pixel.r - value) * (pixel.g - value) / static_cast<double>(extent.area());
        }
        const double variance = 0.004 * 0.004 + 0.001 * value;
        for (const auto& channel : channels) {
            const Statistics s = statistics_of(channel);
            EXPECT_NEAR(s.mean, value, 4 * std::sqrt(variance) / 256);
            EXPECT_NEAR(s.sigma * s.sigma, variance, 0.025 * variance);
        }
        EXPECT_LT(std::abs(cross), 0.02 * variance) << "channels are independent";
    }
}

TEST_F(EncodeTest, TheKeyAloneDecidesTheNoise) {
    const SensorNoise noise = scenes::noise_preset("kinect2");
    const Image<float> depth_m({64, 48}, 3.0f);
    const Image<glm::vec4> radiance({64, 48}, glm::vec4(0.5f));
    const auto depth = encode_depth(depth_m, noise, {1, 2});
    const auto color = expose(radiance, 1, noise, {1, 2}).pixels();
    EXPECT_EQ(encode_depth(depth_m, noise, {1, 2}), depth);
    EXPECT_EQ(expose(radiance, 1, noise, {1, 2}).pixels(), color);
    for (const NoiseKey other : {NoiseKey{2, 2}, {1, 3}, {1 + (uint64_t{1} << 40), 2}}) {
        EXPECT_NE(encode_depth(depth_m, noise, other), depth);
        EXPECT_NE(expose(radiance, 1, noise, other).pixels(), color);
    }
}

TEST_F(EncodeTest, ColorCodesAreThoseOfSrgbAndClip) {
    // IEC 61966-2-1: code 128 is linear 0.2158605; 0.0015 is on the straight part, at 4.94.
    const Image<glm::vec4> linear({2, 1}, {glm::vec4(0, 1, 0.2158605f, 1), glm::vec4(7, 0.0015f, -1, 1)});
    EXPECT_THAT(encode_color(linear), ::testing::ElementsAre(0u | 255u << 8 | 128u << 16, 255u | 5u << 8 | 0u << 16));
}

}  // namespace
}  // namespace patina::encode_test
