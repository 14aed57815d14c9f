#include "scenes/kinect2/infrared_frame.h"

#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/undistort.h"

namespace patina::scenes::kinect2::infrared_frame_test {
namespace {

/// The CRC-32 of zlib, bit by bit.
uint32_t crc32(std::span<const uint8_t> bytes) {
    uint32_t crc = 0xffffffffu;
    for (const uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xedb88320u : 0);
    }
    return ~crc;
}

/// The code of column x in a transmitted row.
uint16_t unpacked(std::span<const uint8_t> row, uint32_t x) {
    const uint32_t bit = 11 * (x / 4 + x % 4 * 128);
    uint32_t code = 0;
    for (uint32_t i = 0; i < 11; ++i) code |= (row[(bit + i) / 8] >> (bit + i) % 8 & 1u) << i;
    return static_cast<uint16_t>(code);
}

/// The sensor of the worked example, with the same phase offsets everywhere.
InfraredSensor example_sensor() {
    InfraredSensor sensor;
    sensor.camera = {kInfraredExtent,  365.402802,       365.402802,
                     260.925507 - 0.5, 205.594604 - 0.5, {0.095575, -0.277055, 0, 0, 0.097539}};
    const uint16_t offsets[] = {0x2C9A, 0x08EC, 0x42E8};
    for (size_t f = 0; f < 3; ++f) sensor.p0[f].assign(kInfraredExtent.area(), offsets[f]);
    return sensor;
}

InfraredScene plane(float depth_m, float amplitude) {
    return {Image<float>(kInfraredExtent, depth_m), Image<float>(kInfraredExtent, amplitude)};
}

std::vector<uint16_t> codes_at(const std::vector<uint8_t>& frame, uint32_t x, uint32_t y) {
    const uint32_t row = y < 212 ? y : 635 - y;
    std::vector<uint16_t> codes;
    for (size_t i = 0; i < 9; ++i)
        codes.push_back(unpacked(std::span(frame).subspan(i * kSubImageBytes + row * kRowBytes, kRowBytes), x));
    return codes;
}

TEST(InfraredFrame, CodesStandForOctavesWithASign) {
    const std::pair<int, int> pairs[] = {{0, 0},      {127, 127},    {128, 128},  {256, 256},   {257, 258},
                                         {383, 510},  {384, 512},    {512, 1024}, {640, 2048},  {768, 4096},
                                         {896, 8192}, {1023, 16320}, {1025, -1},  {1152, -128}, {2047, -16320}};
    for (const auto& [code, value] : pairs) EXPECT_EQ(encode(value), code) << value;
}

TEST(InfraredFrame, TheNearestCodeIsTaken) {
    EXPECT_EQ(encode(256.9), 256);
    EXPECT_EQ(encode(257.1), 257);
    EXPECT_EQ(encode(-0.4), 0) << "code 1024 would be saturated, not -0";
    EXPECT_EQ(encode(16320.5), kSaturatedCode);
    EXPECT_EQ(encode(-1e9), kSaturatedCode);
    EXPECT_EQ(encode(std::nan("")), kSaturatedCode);
}

TEST(InfraredFrame, ARowIsPackedAsDocumented) {
    std::array<uint16_t, 512> codes{};
    for (size_t x = 0; x < codes.size(); ++x) codes[x] = static_cast<uint16_t>(4 * x % 2048);
    const auto row = pack_row(codes);
    const std::vector<uint8_t> start(row.begin(), row.begin() + 8);
    EXPECT_THAT(start, ::testing::ElementsAre(0x00, 0x80, 0x00, 0x08, 0x60, 0x00, 0x04, 0x28));
    for (uint32_t x = 1; x < 511; ++x) EXPECT_EQ(unpacked(row, x), 4 * x % 2048) << x;
    EXPECT_EQ(unpacked(row, 511), 0) << "the last column carries no data";
    // The documented checksum is of the row with that column's code.
    auto whole = row;
    for (uint32_t bit = 0; bit < 11; ++bit) {
        const uint32_t at = 11 * 511 + bit;
        whole[at / 8] |= static_cast<uint8_t>((4 * 511 % 2048 >> bit & 1) << at % 8);
    }
    EXPECT_EQ(crc32(whole), 0x87413749u);
}

TEST(InfraredFrame, TheWorkedExampleGivesItsCodes) {
    const std::vector<uint8_t> frame = infrared_frame(example_sensor(), plane(1.0f, 300));
    ASSERT_EQ(frame.size(), 2984960u);
    EXPECT_THAT(codes_at(frame, 256, 212), ::testing::ElementsAre(1214, 1130, 276, 263, 1272, 1046, 1298, 209, 82));
}

TEST(InfraredFrame, TravelIsTheInverseOfTheDecodersGeometry) {
    const glm::dvec2 ray(-0.0121107, 0.0188971);
    EXPECT_NEAR(travel_mm(ray, 1000) / 1250, 1.6008, 5e-5) << "as documented, to its digits";
    for (const double z : {500.0, 2000.0, 17000.0}) {
        const glm::dvec2 far_ray(0.6, -0.4);
        const double s = std::sqrt(1 + glm::dot(far_ray, far_ray)), d = travel_mm(far_ray, z);
        EXPECT_NEAR(d * d / (2 * (d * s - 45 * far_ray.x)), z, 1e-9 * z);
    }
}

TEST(InfraredFrame, WhatDoesNotReturnIsDarkAndWhatIsTooBrightIsSaturated) {
    InfraredScene scene = plane(1.0f, 100);
    scene.depth_m.at(100, 50) = 0;
    scene.amplitude.at(101, 400) = 1e5f;
    const std::vector<uint8_t> frame = infrared_frame(example_sensor(), scene);
    EXPECT_THAT(codes_at(frame, 100, 50), ::testing::Each(0));
    EXPECT_THAT(codes_at(frame, 101, 400), ::testing::Contains(kSaturatedCode));
    EXPECT_THAT(codes_at(frame, 102, 400), ::testing::Not(::testing::Contains(kSaturatedCode)));
}

TEST(InfraredFrame, NoiseFollowsItsSeedAndItsVariance) {
    const InfraredSensor sensor = example_sensor();
    const InfraredScene scene = plane(1.0f, 300);
    const MeasurementNoise noise{100, 1, 7};
    EXPECT_EQ(infrared_frame(sensor, scene, noise), infrared_frame(sensor, scene, noise));
    const auto codes = [&](uint64_t seed) { return infrared_frame(sensor, scene, {100, 1, seed}); };
    EXPECT_NE(codes(7), codes(8));

    // The first phase of the second frequency at one row: all pixels' light differs by the ray's length alone.
    const std::vector<uint8_t> noisy = codes(7), clean = infrared_frame(sensor, scene);
    double squares = 0;
    const auto value = [](uint16_t code) { return code < 1024 ? code : 1024 - code; };
    for (uint32_t x = 1; x < 511; ++x) {
        const int difference = value(codes_at(noisy, x, 100)[5]) - value(codes_at(clean, x, 100)[5]);
        squares += difference * difference;
    }
    // 510 samples know a standard deviation of 20 to 3 %; five times that. Values below 256 have steps of 1.
    EXPECT_NEAR(std::sqrt(squares / 510), 20, 3);
}

TEST(InfraredFrame, ARenderedPictureIsMirroredAndDistorted) {
    const InfraredSensor sensor = example_sensor();
    const Intrinsics pinhole{{640, 480}, 400, 400, 319.5, 239.5, {}};
    Image<float> columns(pinhole.extent);
    for (uint32_t y = 0; y < 480; ++y) {
        for (uint32_t x = 0; x < 640; ++x) columns.at(x, y) = static_cast<float>(x + 1);
    }
    const Image<float> seen = as_transmitted(sensor.camera, columns, pinhole);
    for (const uint32_t x : {30u, 256u, 480u}) {
        const auto ray = undistort(
            sensor.camera, {(x - sensor.camera.cx) / sensor.camera.fx, (200 - sensor.camera.cy) / sensor.camera.fy});
        ASSERT_TRUE(ray);
        EXPECT_NEAR(seen.at(x, 200), 319.5 - 400 * ray->x + 1, 0.5 + 1e-4) << x;
    }
}

TEST(InfraredFrame, LightFallsWithTheSquareOfTheDistance) {
    const Image<float> depth_m({3, 1}, {1, 2, 0}), white({3, 1}, 0.5f);
    EXPECT_THAT(lit_amplitude(depth_m, white, 400).pixels(), ::testing::ElementsAre(200, 50, 0));
    EXPECT_THROW(lit_amplitude(depth_m, Image<float>({2, 1}), 400), Error);
}

TEST(InfraredFrame, PicturesOfAnotherSizeAreAnError) {
    InfraredScene scene = plane(1, 300);
    scene.amplitude = Image<float>({512, 423});
    try {
        infrared_frame(example_sensor(), scene);
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "an infrared frame needs a picture of amplitudes of 512 x 424, not of 512 x 423");
    }
}

TEST(Undistort, IsTheInverseOfDistort) {
    Intrinsics camera = example_sensor().camera;
    camera.distortion = {0.0956, -0.277, 0.002, -0.001, 0.0975};
    for (const glm::dvec2 point : {glm::dvec2(0), glm::dvec2(0.7, 0.55), glm::dvec2(-0.7, 0.1)}) {
        const auto found = undistort(camera, distort(camera, point));
        ASSERT_TRUE(found);
        EXPECT_LT(glm::length(*found - point), 1e-10);
    }
}

TEST(Undistort, BeyondTheFoldThereIsNothing) {
    // r (1 - r^2 / 2) is 0.544 at most.
    const Intrinsics camera{{64, 64}, 50, 50, 31.5, 31.5, {-0.5, 0, 0, 0, 0}};
    EXPECT_TRUE(undistort(camera, {0.5, 0}));
    EXPECT_FALSE(undistort(camera, {0.6, 0}));
}

}  // namespace
}  // namespace patina::scenes::kinect2::infrared_frame_test
