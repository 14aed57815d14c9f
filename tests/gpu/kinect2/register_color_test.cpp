#include "passes/kinect2/register_color.h"

#include "tests/gpu/kinect2/kinect2_test.h"

namespace patina::register_color_test {
namespace {

class RegisterColorTest : public Kinect2Test {
  protected:
    Image<uint32_t> register_color(kinect2::Tables& of, const Image<float>& depth_m, const Image<SrgbPixel>& color) {
        graph::FrameGraph frame = runner().begin();
        const auto depth = frame.upload("depth", {depth_m.extent(), vulkan::Format::kR32f},
                                        std::as_bytes(std::span(depth_m.pixels())));
        const kinect2::TableIds ids = of.import(frame);
        const auto id = kinect2::add_register_color(frame, of, ids, depth, color.pixels());
        const graph::Readback registered = frame.read_back(id);
        run(std::move(frame));
        return registered.image<uint32_t>();
    }

    /// A colour picture whose pixels say where they are.
    static Image<SrgbPixel> coordinates() {
        Image<SrgbPixel> picture(kinect2::kColorExtent);
        for (uint32_t y = 0; y < 1080; ++y) {
            for (uint32_t x = 0; x < 1920; ++x) picture.at(x, y) = SrgbPixel(x & 255, y & 255, x >> 8 | y >> 8 << 4);
        }
        return picture;
    }
    static glm::dvec2 place_in(uint32_t color) {
        const uint32_t r = color & 255, g = color >> 8 & 255, b = color >> 16 & 255;
        return {r | (b & 15) << 8, g | (b >> 4) << 8};
    }
};

/// A camera pair whose geometry is known: without lens distortion, the colour camera 52 mm beside the depth camera and
/// turned about the optical axis.
struct KnownPair {
    kinect2::CameraModel model = test_camera();
    double turn = 0.005;

    KnownPair() {
        model.depth.distortion = {};
        auto& color = model.color;
        color.mx = color.my = {};
        // The inverse of the formula: its polynomials are linear in the ray, whose units are 100 pixels.
        const double per_ray = 100 / model.depth.fx;
        color.mx[7] = 0.002199 * color.f * per_ray * std::cos(turn);
        color.mx[8] = -0.002199 * color.f * per_ray * std::sin(turn);
        color.my[7] = 0.002199 * color.f * per_ray * std::sin(turn);
        color.my[8] = 0.002199 * color.f * per_ray * std::cos(turn);
        color.mx[9] = 0.002199 * color.f * color.shift_m / color.shift_d;
        // The polynomials count from the pixels' corners, rays from their centres.
        const double half = 0.5 / model.depth.fx, scale = 0.002199 * color.f;
        color.mx[9] += scale * half * (std::cos(turn) - std::sin(turn));
        color.my[9] += scale * half * (std::sin(turn) + std::cos(turn));
    }

    /// Where the colour camera sees a depth pixel, both mirrored back: by rays and rotation, not by the formula.
    glm::dvec2 seen(const Intrinsics& depth, uint32_t x, uint32_t y, double z_m) const {
        const glm::dvec3 point((511.0 - x - model.depth.cx) / depth.fx * z_m, (y - depth.cy) / depth.fy * z_m, z_m);
        const glm::dvec3 turned(std::cos(turn) * point.x - std::sin(turn) * point.y + 0.052,
                                std::sin(turn) * point.x + std::cos(turn) * point.y, point.z);
        const glm::dvec2 px =
            model.color.f * glm::dvec2(turned) / turned.z + glm::dvec2(model.color.cx, model.color.cy);
        return {1919 - px.x, px.y};
    }
};

TEST_F(RegisterColorTest, ASyntheticPairFitsWithinHalfAPixel) {
    const KnownPair pair;
    kinect2::Tables tables(device(), pair.model);
    const Image<SrgbPixel> color = coordinates();
    for (const float z : {0.6f, 1.0f, 2.5f, 4.4f}) {
        const auto registered = register_color(tables, Image<float>(kinect2::kInfraredExtent, z), color);
        size_t found = 0;
        for (uint32_t y = 0; y < 424; ++y) {
            for (uint32_t x = 0; x < 512; ++x) {
                if (registered.at(x, y) == 0) continue;
                ++found;
                const glm::dvec2 off = place_in(registered.at(x, y)) - pair.seen(tables.host().depth, x, y, z);
                // The nearest pixel; the rest is single precision at 1920 pixels.
                ASSERT_LE(std::abs(off.x), 0.5 + 1e-3) << x << ' ' << y << ' ' << z;
                ASSERT_LE(std::abs(off.y), 0.5 + 1e-3) << x << ' ' << y << ' ' << z;
            }
        }
        EXPECT_GT(found, 150000u) << "of 217088; the colour picture does not show the upper and lower border";
    }
}

TEST_F(RegisterColorTest, WhatTheColourCameraDoesNotSeeHasNoColour) {
    const KnownPair pair;
    kinect2::Tables tables(device(), pair.model);
    Image<float> depth_m(kinect2::kInfraredExtent, 3.0f);
    for (uint32_t y = 0; y < 424; ++y) {
        for (uint32_t x = 240; x < 280; ++x) depth_m.at(x, y) = 1.0f;
    }
    depth_m.at(100, 200) = 0;
    const auto registered = register_color(tables, depth_m, coordinates());
    EXPECT_EQ(registered.at(100, 200), 0u);
    // In the mirrored-back picture the near strip is moved to the left of the far wall by the difference of 1 / z.
    const double shift_px = 0.052 * (1 / 1.0 - 1 / 3.0) * pair.model.depth.fx;
    const auto hidden_from = static_cast<uint32_t>(240 - shift_px);
    for (uint32_t x = 200; x < 240; ++x) {
        if (x + 1 >= hidden_from && x <= hidden_from + 1) continue;  // the strip's margin
        EXPECT_EQ(registered.at(x, 200) == 0, x > hidden_from) << x << ' ' << hidden_from;
    }
    for (uint32_t x = 240; x < 300; ++x) EXPECT_NE(registered.at(x, 200), 0u) << x;
}

TEST_F(RegisterColorTest, AgreesWithTheReferenceThatMapsTheColourPicture) {
    Image<float> depth_m(kinect2::kInfraredExtent);
    for (uint32_t y = 0; y < 424; ++y) {
        for (uint32_t x = 0; x < 512; ++x) {
            const float step = (x / 37 + y / 29) % 3 == 0 ? 1.2f : 0.0f;
            depth_m.at(x, y) = (x * 7 + y * 3) % 50 == 0 ? 0 : 0.8f + step + 0.002f * static_cast<float>(x);
        }
    }
    const Image<SrgbPixel> color = coordinates();
    const auto got = register_color(tables(), depth_m, color);
    const auto expected = reference::kinect2::register_color(model(), depth_m, color);
    size_t known = 0, hidden = 0, apart = 0, differing = 0;
    for (size_t i = 0; i < got.pixels().size(); ++i) {
        known += expected.pixels()[i] != 0;
        hidden += expected.pixels()[i] == 0 && depth_m.pixels()[i] > 0;
        differing += (got.pixels()[i] == 0) != (expected.pixels()[i] == 0);
        if (got.pixels()[i] != 0 && expected.pixels()[i] != 0) apart += got.pixels()[i] != expected.pixels()[i];
    }
    EXPECT_GT(known, 100000u);
    EXPECT_GT(hidden, 5000u);
    EXPECT_LT(apart, known / 1000) << "places at half a pixel may be rounded otherwise";
    // A map of the colour picture lets depth pixels hide those of the next row, too; here a row is its own.
    EXPECT_LT(differing, got.pixels().size() / 200);
}

TEST_F(RegisterColorTest, APictureOfAnotherSizeIsAnError) {
    const Image<float> depth_m(kinect2::kInfraredExtent, 1.0f);
    try {
        register_color(tables(), depth_m, Image<SrgbPixel>({1920, 1079}));
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "the pass 'kinect2.register_color' got 2071680 pixels for a picture of 1920 x 1080");
    }
}

}  // namespace
}  // namespace patina::register_color_test
