#include "passes/input/convert_color.h"

#include <limits>

#include <glm/gtc/packing.hpp>

#include "shared/input/convert_color.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/reference/input/convert_color.h"

namespace patina::convert_color_test {
namespace {

using gpu::kColorClipped;
using gpu::kColorInvalid;
using gpu::kColorValid;

/// Half floats round at 2^-11 to nearest, at 2^-10 towards zero; Vulkan leaves the choice to the device.
constexpr float kRelativeTolerance = 1e-3f;

class ConvertColorTest : public GpuTest {
  protected:
    Image<glm::vec4> convert(const ColorInput& input) {
        graph::FrameGraph frame = runner().begin();
        const graph::Readback result = frame.read_back(add_convert_color(frame, input));
        run(std::move(frame));
        std::vector<glm::vec4> pixels;
        for (const uint64_t halves : result.as<uint64_t>()) pixels.push_back(glm::unpackHalf4x16(halves));
        return {input.camera.extent, pixels};
    }

    std::vector<Image<glm::vec4>> convert_both(const ColorInput& input) {
        return {convert(input), reference::convert_color(input)};
    }
};

ColorInput srgb(const std::vector<glm::u8vec3>& pixels, const Intrinsics& camera) {
    return {std::span<const glm::u8vec3>(pixels), camera};
}

ColorInput linear(const std::vector<glm::vec3>& pixels, const Intrinsics& camera) {
    return {std::span<const glm::vec3>(pixels), camera};
}

void expect_near(const glm::vec4& got, const glm::vec4& expected, const std::string& where, float tolerance = 0) {
    ASSERT_EQ(got.a, expected.a) << where;
    for (int i = 0; i < 3; ++i) ASSERT_NEAR(got[i], expected[i], kRelativeTolerance * expected[i] + tolerance) << where;
}

TEST_F(ConvertColorTest, DecodesAllValuesOfSrgb) {
    std::vector<glm::u8vec3> pixels;
    for (int code = 0; code < 256; ++code) pixels.emplace_back(code, 255 - code, code ^ 0x55);
    const auto decoded = [](int code) {  // IEC 61966-2-1
        const double c = code / 255.0;
        return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    };
    for (const auto& color : convert_both(srgb(pixels, pinhole_camera({256, 1})))) {
        for (uint32_t x = 0; x < 256; ++x) {
            const glm::u8vec3 code = pixels[x];
            const bool clipped = code.r == 255 || code.g == 255 || code.b == 255;
            expect_near(color.at(x, 0),
                        {decoded(code.r), decoded(code.g), decoded(code.b), clipped ? kColorClipped : kColorValid},
                        text("code ", x));
        }
    }
}

TEST_F(ConvertColorTest, FloatsAreClampedOrDropped) {
    constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<glm::vec3> pixels = {{1, 2, 3},    {-1, 0, 0.5f}, {1, 1e6f, 2}, {65504, 0, 0},
                                           {kNan, 1, 1}, {1, kInf, 1},  {1, 1, -kInf}};
    const std::vector<glm::vec4> expected = {{1, 2, 3, kColorValid},
                                             {0, 0, 0.5f, kColorValid},
                                             {1, 65504, 2, kColorClipped},
                                             {65504, 0, 0, kColorValid},
                                             glm::vec4(0),
                                             glm::vec4(0),
                                             glm::vec4(0)};
    static_assert(kColorInvalid == 0);
    for (const auto& color : convert_both(linear(pixels, pinhole_camera({7, 1})))) {
        EXPECT_EQ(color.pixels(), expected);
    }
}

TEST_F(ConvertColorTest, InterpolatesARampExactlyAndDropsWhatLiesOutside) {
    Intrinsics camera = distorted_camera({65, 33});
    camera.distortion[0] = 0.3;  // moves the corners out of the picture
    std::vector<glm::vec3> pixels;
    for (uint32_t y = 0; y < 33; ++y) {
        for (uint32_t x = 0; x < 65; ++x) pixels.emplace_back(10 + x, 10 + y, 30 + 2.0f * x - y * 0.5f);
    }
    for (const auto& color : convert_both(linear(pixels, camera))) {
        int outside = 0;
        for (uint32_t y = 0; y < 33; ++y) {
            for (uint32_t x = 0; x < 65; ++x) {
                const glm::dvec2 px = distorted_px(camera, x, y);
                const bool seen = px.x >= -0.5 && px.y >= -0.5 && px.x < 64.5 && px.y < 32.5;
                outside += !seen;
                const glm::dvec2 at = glm::clamp(px, glm::dvec2(0), glm::dvec2(64, 32));
                const glm::vec4 ramp(10 + at.x, 10 + at.y, 30 + 2 * at.x - at.y * 0.5, kColorValid);
                expect_near(color.at(x, y), seen ? ramp : glm::vec4(0), text(x, ' ', y));
            }
        }
        EXPECT_GT(outside, 20);
    }
}

TEST_F(ConvertColorTest, OneBadPixelMarksWhatItWentInto) {
    Intrinsics camera = pinhole_camera({9, 9});
    camera.distortion[2] = 0.04;  // p1 shifts the picture by fractions of a pixel
    std::vector<glm::vec3> pixels(81, glm::vec3(0.5f));
    pixels[4 * 9 + 4] = glm::vec3(1e9f, 0.5f, 0.5f);
    for (const auto& color : convert_both(linear(pixels, camera))) {
        for (uint32_t y = 0; y < 9; ++y) {
            for (uint32_t x = 0; x < 9; ++x) {
                const glm::dvec2 px = distorted_px(camera, x, y);
                if (at_rounding_limit(px) || color.at(x, y).a == kColorInvalid) continue;
                const bool used = std::abs(px.x - 4) < 1 && std::abs(px.y - 4) < 1;
                EXPECT_EQ(color.at(x, y).a, used ? kColorClipped : kColorValid) << x << ' ' << y;
                EXPECT_EQ(color.at(x, y).r == 0.5f, !used) << x << ' ' << y;
            }
        }
    }
}

TEST_F(ConvertColorTest, AgreesWithTheReference) {
    std::mt19937 random(3);
    for (const Extent2D extent : kPictureExtents) {
        for (const Intrinsics& camera : {pinhole_camera(extent), distorted_camera(extent)}) {
            std::vector<glm::u8vec3> bytes(extent.area());
            for (auto& pixel : bytes) pixel = glm::u8vec3(random(), random(), random());
            std::vector<glm::vec3> floats(bytes.begin(), bytes.end());
            for (auto& pixel : floats) pixel /= 64.0f;
            for (const ColorInput& input : {srgb(bytes, camera), linear(floats, camera)}) {
                const Image<glm::vec4> got = convert(input), expected = reference::convert_color(input);
                for (uint32_t y = 0; y < extent.height; ++y) {
                    for (uint32_t x = 0; x < extent.width; ++x) {
                        if (camera.distorted() && at_rounding_limit(distorted_px(camera, x, y))) continue;
                        // Single precision places a pixel to 1e-4; neighbours here differ by up to 4.
                        expect_near(got.at(x, y), expected.at(x, y), text(extent, " at ", x, ' ', y),
                                    camera.distorted() ? 4e-4f : 0.0f);
                        if (HasFatalFailure()) return;
                    }
                }
            }
        }
    }
}

TEST_F(ConvertColorTest, AWrongNumberOfPixelsIsAnError) {
    const std::vector<glm::u8vec3> pixels(6);
    graph::FrameGraph frame = runner().begin();
    EXPECT_THAT(
        [&] {
            add_convert_color(frame, srgb(pixels, pinhole_camera({3, 3})));
        },
        ::testing::ThrowsMessage<Error>("the pass 'input.convert_color' got 6 pixels for a picture of 3 x 3"));
}

}  // namespace
}  // namespace patina::convert_color_test
