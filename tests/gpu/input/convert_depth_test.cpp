#include "passes/input/convert_depth.h"

#include <limits>

#include "tests/gpu/gpu_test.h"
#include "tests/gpu/input/input_pictures.h"
#include "tests/reference/input/convert_depth.h"

namespace patina::convert_depth_test {
namespace {

class ConvertDepthTest : public GpuTest {
  protected:
    Image<float> convert(const DepthInput& input) {
        graph::FrameGraph frame = runner().begin();
        const graph::Readback result = frame.read_back(add_convert_depth(frame, input));
        run(std::move(frame));
        return result.image<float>();
    }

    /// The shader's result and the reference's, for tests that know the answer.
    std::vector<Image<float>> convert_both(const DepthInput& input) {
        return {convert(input), reference::convert_depth(input)};
    }
};

DepthInput units(const std::vector<uint16_t>& pixels, const Intrinsics& camera) {
    return {std::span<const uint16_t>(pixels), camera};
}

DepthInput metres(const std::vector<float>& pixels, const Intrinsics& camera) {
    return {std::span<const float>(pixels), camera};
}

TEST_F(ConvertDepthTest, UnitsBecomeMetresUpToTheLimit) {
    const std::vector<uint16_t> pixels = {0, 1, 1000, 7999, 8000, 8001, 65535};
    const float expected[] = {0, 0.001f, 1, 7.999f, 8, 0, 0};
    for (const auto& depth_m : convert_both(units(pixels, pinhole_camera({7, 1})))) {
        for (uint32_t x = 0; x < 7; ++x) EXPECT_FLOAT_EQ(depth_m.at(x, 0), expected[x]) << pixels[x];
    }
}

TEST_F(ConvertDepthTest, EveryUnitIsValidWhereTheLimitLiesBeyondThem) {
    const std::vector<uint16_t> pixels = {1, 65535};
    DepthInput input = units(pixels, pinhole_camera({2, 1}));
    input.metres_per_unit = 1e-4;
    for (const auto& depth_m : convert_both(input)) {
        EXPECT_FLOAT_EQ(depth_m.at(0, 0), 1e-4f);
        EXPECT_FLOAT_EQ(depth_m.at(1, 0), 6.5535f);
    }
}

TEST_F(ConvertDepthTest, FloatsThatAreNoReadingBecomeZero) {
    constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> pixels = {kNan, -kNan, kInf, -kInf, -1, -0.0f, 0, std::nextafter(8.0f, 9.0f), 8, 0.25f};
    for (const auto& depth_m : convert_both(metres(pixels, pinhole_camera({10, 1})))) {
        EXPECT_EQ(depth_m.pixels(), (std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0, 8, 0.25f}));
    }
}

/// The pinhole camera's normalised image point that a distorted pixel shows.
glm::dvec2 undistorted(const Intrinsics& camera, uint32_t x, uint32_t y) {
    const glm::dvec2 wanted((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy);
    glm::dvec2 point = wanted;
    for (int i = 0; i < 100; ++i) point += wanted - distort(camera, point);
    EXPECT_LT(glm::length(distort(camera, point) - wanted), 1e-9);
    return point;
}

TEST_F(ConvertDepthTest, AStraightEdgeInTheWorldBecomesStraight) {
    Intrinsics camera = pinhole_camera({160, 120});
    camera.distortion = {0.2, 0.1, 0.01, -0.005, 0.05};
    const glm::dvec2 normal = glm::normalize(glm::dvec2(1, 0.3));
    const double offset = 0.45;  // near the right border, where the lens bends most
    std::vector<float> pixels;
    for (uint32_t y = 0; y < 120; ++y) {
        for (uint32_t x = 0; x < 160; ++x) {
            pixels.push_back(glm::dot(undistorted(camera, x, y), normal) < offset ? 1.0f : 2.0f);
        }
    }
    const auto wrong_pixels = [&](const Image<float>& depth_m) {
        int wrong = 0;
        for (uint32_t y = 0; y < 120; ++y) {
            for (uint32_t x = 0; x < 160; ++x) {
                const glm::dvec2 point((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy);
                const double distance_px = (glm::dot(point, normal) - offset) * camera.fx;
                // The nearest pixel lies at most half a diagonal away.
                if (std::abs(distance_px) < 0.8 || depth_m.at(x, y) == 0) continue;
                wrong += depth_m.at(x, y) != (distance_px < 0 ? 1.0f : 2.0f);
            }
        }
        return wrong;
    };
    for (const auto& depth_m : convert_both(metres(pixels, camera))) EXPECT_EQ(wrong_pixels(depth_m), 0);
    EXPECT_GT(wrong_pixels(Image<float>({160, 120}, pixels)), 100) << "the lens must bend the edge to begin with";
}

TEST_F(ConvertDepthTest, BeyondTheRadiusWhereDistortionFoldsBackNothingIsSeen) {
    Intrinsics camera{{65, 33}, 30, 30, 32, 16, {-0.5, 0, 0, 0, 0}};
    const std::vector<uint16_t> pixels(camera.extent.area(), 1000);
    const Image<float> depth_m = convert(units(pixels, camera));
    for (uint32_t y = 0; y < 33; ++y) {
        for (uint32_t x = 0; x < 65; ++x) {
            // r (1 - r^2 / 2) is largest at r^2 = 2 / 3, and never leaves this picture.
            const double r2 = (std::pow(x - 32.0, 2) + std::pow(y - 16.0, 2)) / 900;
            if (std::abs(r2 - 2.0 / 3) < 0.01) continue;
            EXPECT_EQ(depth_m.at(x, y), r2 < 2.0 / 3 ? 1.0f : 0.0f) << x << ' ' << y;
        }
    }
}

TEST_F(ConvertDepthTest, AgreesWithTheReference) {
    std::mt19937 random(7);
    for (const Extent2D extent : kPictureExtents) {
        for (const Intrinsics& camera : {pinhole_camera(extent), distorted_camera(extent)}) {
            std::vector<uint16_t> raw(extent.area());
            for (auto& code : raw) code = static_cast<uint16_t>(random() % 10000);
            std::vector<float> floats(raw.begin(), raw.end());
            for (auto& value : floats) value *= 0.001f;
            for (const DepthInput& input : {units(raw, camera), metres(floats, camera)}) {
                const Image<float> got = convert(input), expected = reference::convert_depth(input);
                ASSERT_EQ(got.extent(), extent);
                for (uint32_t y = 0; y < extent.height; ++y) {
                    for (uint32_t x = 0; x < extent.width; ++x) {
                        if (camera.distorted() && at_rounding_limit(distorted_px(camera, x, y))) continue;
                        ASSERT_FLOAT_EQ(got.at(x, y), expected.at(x, y)) << extent << " at " << x << ' ' << y;
                    }
                }
            }
        }
    }
}

TEST_F(ConvertDepthTest, InputWithoutUseIsAnError) {
    const std::vector<uint16_t> pixels(6);
    const auto message = [&](const DepthInput& input) -> std::string {
        graph::FrameGraph frame = runner().begin();
        try {
            add_convert_depth(frame, input);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message(units(pixels, pinhole_camera({3, 3}))),
              "the pass 'input.convert_depth' got 6 pixels for a picture of 3 x 3");
    DepthInput input = units(pixels, pinhole_camera({3, 2}));
    EXPECT_EQ(message(input), "");
    input.metres_per_unit = 0;
    EXPECT_EQ(message(input),
              "the pass 'input.convert_depth' got a scale without use: 0 metres per unit, readings up to 8 m");
    input = units(pixels, pinhole_camera({3, 2}));
    input.max_metres = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(message(input), ::testing::HasSubstr("readings up to nan m"));
    input = units(pixels, {{3, 2}, 0, 0, 0, 0, {}});
    EXPECT_THAT(message(input), ::testing::HasSubstr("without usable intrinsics: fx 0"));
}

}  // namespace
}  // namespace patina::convert_depth_test
