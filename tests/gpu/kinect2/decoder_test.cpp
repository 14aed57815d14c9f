#include <fstream>
#include <iterator>
#include <limits>

#include "cameras/kinect2_recorded.h"
#include "scenes/description/scene.h"
#include "scenes/files/scene_file.h"
#include "scenes/render/synthetic_source.h"
#include "sensor/files/picture_file.h"
#include "tests/export/temporary_folder.h"
#include "tests/gpu/kinect2/kinect2_test.h"
#include "tests/simulated_kinect2/pages.h"

namespace patina::decoder_test {
namespace {

using sensor::kinect2::RawFrame;

/// The calibration of test_camera().
sensor::kinect2::Calibration calibration() {
    const kinect2::CameraModel model = test_camera();
    const auto& k = model.depth.distortion;
    sensor::kinect2::Calibration result;
    const auto single = [](double value) { return static_cast<float>(value); };
    result.depth = {single(model.depth.fx),
                    single(model.depth.fy),
                    single(model.depth.cx + 0.5),
                    single(model.depth.cy + 0.5),
                    single(k[0]),
                    single(k[1]),
                    single(k[2]),
                    single(k[3]),
                    single(k[4])};
    result.color.f = single(model.color.f);
    result.color.cx = single(model.color.cx);
    result.color.cy = single(model.color.cy);
    result.color.shift_d = single(model.color.shift_d);
    result.color.shift_m = single(model.color.shift_m);
    std::copy(model.color.mx.begin(), model.color.mx.end(), result.color.mx.begin());
    std::copy(model.color.my.begin(), model.color.my.end(), result.color.my.begin());
    result.p0 = model.p0;
    return result;
}

/// A picture's file as bytes. PNG keeps every pixel; a camera's JPEG goes the same way.
std::vector<uint8_t> encoded(const Image<SrgbPixel>& picture) {
    const test::TemporaryFolder folder;
    sensor::write_png(folder / "picture.png", picture);
    std::ifstream file(folder / "picture.png", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Red grows from left to right, as the camera sends it.
Image<SrgbPixel> sent_picture() {
    Image<SrgbPixel> picture(Extent2D{1920, 1080});
    for (uint32_t y = 0; y < 1080; ++y) {
        for (uint32_t x = 0; x < 1920; ++x) picture.at(x, y) = SrgbPixel(x / 8, 40, 80);
    }
    return picture;
}

class Kinect2DecoderTest : public Kinect2Test {
  protected:
    static RawFrame raw_plane(float depth_m) {
        RawFrame raw;
        raw.infrared = scenes::kinect2::infrared_frame(
            simulated(model()),
            {Image<float>(kinect2::kInfraredExtent, depth_m), Image<float>(kinect2::kInfraredExtent, 300.0f)});
        raw.color = encoded(sent_picture());
        raw.color_exposure_ms = 8;
        raw.color_gain = 1.25f;
        return raw;
    }

    const sensor::RecordedSequence sequence_ =
        cameras::kinect2_sequence(sensor::kinect2::testing::pages_of(calibration()), "kinect");
    cameras::Kinect2Packer packer_;
    cameras::Kinect2PayloadDecoder decoder_{[this]() -> vulkan::Device& { return device(); }, sequence_, "kinect"};
};

TEST_F(Kinect2DecoderTest, TheFittedColourCameraAgreesWithTheDevicesPolynomials) {
    const cameras::FittedColorCamera fitted = cameras::fit_color_camera(tables().host());
    // The polynomials have cubic terms that no lens of five coefficients has; they are a third of a colour pixel, of
    // which three make a depth pixel.
    EXPECT_LT(fitted.rms_px, 0.4);
    EXPECT_LT(fitted.max_px, 1.2);
    EXPECT_LT(rotation_defect(fitted.color_from_depth), 1e-9);
    EXPECT_NEAR(glm::length(glm::dvec3(fitted.color_from_depth[3])), 0.052, 0.004);
    const Intrinsics depth = tables().host().depth;
    for (const double z : {0.7, 1.5, 4.0}) {
        for (const glm::uvec2 at : {glm::uvec2(256, 212), {60, 100}, {450, 330}}) {
            const glm::dvec3 point((at.x - depth.cx) / depth.fx * z, (at.y - depth.cy) / depth.fy * z, z);
            const glm::dvec2 seen = project(fitted.color, glm::dvec3(fitted.color_from_depth * glm::dvec4(point, 1)));
            const glm::dvec2 place = reference::kinect2::color_place(model(), at.x, at.y, z);
            EXPECT_LT(glm::length(seen - place), 1.2) << at.x << ' ' << at.y << ' ' << z;
        }
    }
}

TEST_F(Kinect2DecoderTest, AFrameIsMirroredBackWithItsTimeAndExposure) {
    const SequenceInfo info = sequence_.info;
    EXPECT_FALSE(info.frames);
    EXPECT_EQ(info.depth.extent, kinect2::kInfraredExtent);
    EXPECT_FALSE(info.depth.distorted());
    EXPECT_NEAR(info.depth.cx, 511 - (260.925507 - 0.5), 1e-4);

    RawFrame first = raw_plane(1.5f), second = raw_plane(1.5f);
    first.timestamp = 0xffffffff - 99;
    second.timestamp = 167;  // the clock has wrapped
    const sensor::RecordedFrame recorded = packer_.pack(std::move(first));
    EXPECT_EQ(recorded.index, 0u);
    EXPECT_EQ(recorded.timestamp_s, 0);
    EXPECT_DOUBLE_EQ(recorded.exposure.exposure_s, 0.008);
    EXPECT_EQ(recorded.exposure.gain, 1.25);
    Frame frame;
    decoder_.decode(recorded, frame);
    const auto& color = std::get<Image<SrgbPixel>>(frame.color);
    EXPECT_EQ(color.at(0, 500), SrgbPixel(239, 40, 80));
    EXPECT_EQ(color.at(1919, 500), SrgbPixel(0, 40, 80));
    EXPECT_NEAR(std::get<Image<float>>(frame.depth).at(256, 212), 1.5f, 0.001f);

    const sensor::RecordedFrame next = packer_.pack(std::move(second));
    EXPECT_EQ(next.index, 1u);
    EXPECT_DOUBLE_EQ(next.timestamp_s, 267 * 125e-6);
}

TEST_F(Kinect2DecoderTest, ADamagedFrameIsToldApartAndTheNextOneIsWhole) {
    std::vector<RawFrame> raws(4, raw_plane(1.5f));
    raws[0].infrared.resize(1000);
    raws[1].color.resize(raws[1].color.size() / 2);
    raws[2].color = encoded(Image<SrgbPixel>(Extent2D{64, 48}));
    const char* reasons[] = {"kinect: frame 0 has an infrared frame of 1000 bytes, but 2686464 are needed",
                             "kinect: frame 1", "kinect: frame 2 is 64 x 48 pixels, but the sequence says 1920 x 1080"};
    for (uint32_t i = 0; i < 3; ++i) {
        Frame frame;
        try {
            decoder_.decode(packer_.pack(std::move(raws[i])), frame);
            ADD_FAILURE() << i;
        } catch (const sensor::DamagedFrame& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr(reasons[i]));
        }
    }
    Frame frame;
    decoder_.decode(packer_.pack(std::move(raws[3])), frame);
    EXPECT_NEAR(std::get<Image<float>>(frame.depth).at(256, 212), 1.5f, 0.001f);
}

TEST_F(Kinect2DecoderTest, WhatTheDeviceSaysOfAFrameIsFiniteInAnyCase) {
    RawFrame raw;
    raw.color_exposure_ms = std::numeric_limits<float>::infinity();
    raw.color_gain = std::numeric_limits<float>::quiet_NaN();
    raw.color_gamma = 2.5f;
    const sensor::RecordedFrame recorded = packer_.pack(std::move(raw));
    EXPECT_EQ(recorded.exposure, Exposure{});
    EXPECT_EQ(recorded.payloads.at(1).attributes, R"({"exposure_ms": null, "gain": null, "gamma": 2.5})");
}

TEST_F(Kinect2DecoderTest, TheInfraredPictureComesWhereItIsAskedFor) {
    const RawFrame raw = raw_plane(1.5f);
    cameras::Kinect2Decoder plain(device(), model()), with_infrared(device(), model(), true);
    const auto without = plain.decode(raw.infrared, raw.color, "kinect");
    const auto pictures = with_infrared.decode(raw.infrared, raw.color, "kinect");
    EXPECT_TRUE(without.infrared.empty());
    EXPECT_EQ(pictures.depth_m.pixels(), without.depth_m.pixels());
    // 16 times the mean of the amplitudes, which are 300 everywhere, times the gains of the frequencies (libfreenect2's
    // ab_multiplier_per_frq); 11-bit codes are off by 1/128 each at most.
    const double expected = 16 * 300 * (1.322581 + 1.0 + 1.612903) / 3;
    EXPECT_NEAR(pictures.infrared.at(256, 212), expected, expected / 100);
}

TEST_F(Kinect2DecoderTest, ARenderedSceneBecomesPhaseImagesAndDepthAgain) {
    scenes::SyntheticScene scene = scenes::load_scene("cubes");
    scenes::SyntheticSource source(device(), std::move(scene), {.frames = 1});
    const auto reading = source.next();
    ASSERT_TRUE(reading && std::holds_alternative<Frame>(*reading));
    const auto& codes = std::get<Image<uint16_t>>(std::get<Frame>(*reading).depth);
    Image<float> rendered_m(codes.extent());
    for (size_t i = 0; i < rendered_m.pixels().size(); ++i)
        rendered_m.pixels()[i] = static_cast<float>(codes.pixels()[i] * source.info().metres_per_unit);
    const Image<float> seen_m = scenes::kinect2::as_transmitted(model().depth, rendered_m, source.info().depth);
    const Image<float> amplitude = scenes::kinect2::lit_amplitude(seen_m, Image<float>(seen_m.extent(), 0.5f), 3000);

    RawFrame raw;
    raw.infrared = scenes::kinect2::infrared_frame(simulated(model()), {seen_m, amplitude});
    raw.color = encoded(sent_picture());
    cameras::Kinect2Decoder decoder(device(), model());
    const auto pictures = decoder.decode(raw.infrared, raw.color, "kinect");
    const Intrinsics depth = decoder.depth_camera();
    std::vector<double> errors;
    for (uint32_t y = 0; y < depth.extent.height; ++y) {
        for (uint32_t x = 0; x < depth.extent.width; ++x) {
            const float z = pictures.depth_m.at(x, y);
            if (z == 0) continue;
            const glm::dvec2 at =
                project(source.info().depth, {(x - depth.cx) / depth.fx, (y - depth.cy) / depth.fy, 1});
            if (!rendered_m.extent().contains(static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y))))
                continue;
            errors.push_back(std::abs(
                z - rendered_m.at(static_cast<uint32_t>(std::lround(at.x)), static_cast<uint32_t>(std::lround(at.y)))));
        }
    }
    ASSERT_GT(errors.size(), 60000u);
    std::sort(errors.begin(), errors.end());
    // Both pictures are resampled to the nearest pixel, so that a slope of 45 degrees at 3 m is off by 8 mm; the
    // scene's own depth noise is as large.
    EXPECT_LT(errors[errors.size() / 2], 0.004);
    EXPECT_LT(errors[errors.size() * 9 / 10], 0.03);
}

}  // namespace
}  // namespace patina::decoder_test
