#include "sensor/kinect2/calibration.h"

#include <cmath>
#include <cstring>
#include <limits>

#include <gmock/gmock.h>

#include "engine/core/error.h"
#include "tests/simulated_kinect2/pages.h"

namespace patina::sensor::kinect2::testing::calibration_test {
namespace {

using ::testing::HasSubstr;

/// A page as the specification's table has it, not as the simulator writes it.
template <class T>
void set(std::vector<uint8_t>& page, size_t offset, T value) {
    std::memcpy(page.data() + offset, &value, sizeof value);
}

std::string reason_for(const CalibrationPages& pages) {
    try {
        parse_calibration(pages, "unit");
    } catch (const Error& error) {
        return error.what();
    }
    return "none";
}

TEST(Kinect2Calibration, EveryFieldIsReadFromItsOffset) {
    CalibrationPages pages = pages_of(simulated_calibration());
    const float depth[] = {361, 362, 0, 251, 202, 0.1f, -0.2f, 0.01f, 0.02f, 0.3f};  // k1 k2 p1 p2 k3 last
    for (size_t i = 0; i < 10; ++i) set(pages.depth_parameters, 4 * i, depth[i]);
    const float color[] = {1081.5f, 959.25f, 539.75f, 863, 52};
    for (size_t i = 0; i < 5; ++i) set(pages.color_parameters, 1 + 4 * i, color[i]);
    for (size_t i = 0; i < 20; ++i) set(pages.color_parameters, 21 + 4 * i, static_cast<float>(i) + 0.5f);
    set(pages.firmware, 48, uint32_t{5u << 16 | 7u});
    set(pages.firmware, 52, uint32_t{3916});
    set(pages.firmware, 56, uint32_t{2});
    const size_t pixel = 512 * 200 + 100;
    for (size_t f = 0; f < 3; ++f)
        set(pages.p0_tables, 32 + 434180 * f + 2 + 2 * pixel, static_cast<uint16_t>(1000 + f));

    const Calibration calibration = parse_calibration(pages, "unit");
    EXPECT_EQ(calibration.serial, "012345678901");
    EXPECT_EQ(calibration.firmware, "5.7.3916.2");
    const DepthCamera& d = calibration.depth;
    EXPECT_EQ((std::array{d.fx, d.fy, d.cx, d.cy, d.k1, d.k2, d.p1, d.p2, d.k3}),
              (std::array{361.f, 362.f, 251.f, 202.f, 0.1f, -0.2f, 0.01f, 0.02f, 0.3f}));
    const ColorCamera& c = calibration.color;
    EXPECT_EQ((std::array{c.f, c.cx, c.cy, c.shift_d, c.shift_m}),
              (std::array{1081.5f, 959.25f, 539.75f, 863.f, 52.f}));
    for (size_t i = 0; i < 10; ++i) {
        EXPECT_EQ(c.mx[i], static_cast<float>(i) + 0.5f);
        EXPECT_EQ(c.my[i], static_cast<float>(i) + 10.5f);
    }
    for (size_t f = 0; f < 3; ++f) {
        ASSERT_EQ(calibration.p0[f].size(), 512u * 424u);
        EXPECT_EQ(calibration.p0[f][pixel], 1000 + f);
    }
    EXPECT_EQ(calibration.p0[0][0], 0x2C9A);
    EXPECT_EQ(calibration.p0[1][511], 0x08EC);
    EXPECT_EQ(calibration.p0[2].back(), 0x42E8);
}

TEST(Kinect2Calibration, ShortPagesAreRefusedByName) {
    const CalibrationPages whole = pages_of(simulated_calibration());
    CalibrationPages pages = whole;
    pages.depth_parameters.resize(39);
    EXPECT_EQ(reason_for(pages), "unit: the page of depth camera parameters has 39 bytes, must have 40");
    pages = whole;
    pages.color_parameters.resize(100);
    EXPECT_THAT(reason_for(pages), HasSubstr("colour camera parameters has 100 bytes"));
    pages = whole;
    pages.p0_tables.resize(1302571);
    EXPECT_EQ(reason_for(pages), "unit: the page of phase offsets has 1302571 bytes, must have 1302572");
    pages = whole;
    pages.firmware.clear();
    EXPECT_THAT(reason_for(pages), HasSubstr("firmware versions has 0 bytes"));
    EXPECT_NO_THROW(
        parse_calibration({whole.firmware, {}, whole.p0_tables, whole.depth_parameters, whole.color_parameters}, ""))
        << "a device without serial number works";
}

TEST(Kinect2Calibration, AbsurdNumbersAreRefused) {
    const CalibrationPages whole = pages_of(simulated_calibration());
    for (const float value :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e30f}) {
        for (const size_t offset : {0, 4, 12, 16, 20, 24, 28, 32, 36}) {
            CalibrationPages pages = whole;
            set(pages.depth_parameters, offset, value);
            EXPECT_THAT(reason_for(pages), HasSubstr("depth camera parameters has ")) << offset;
        }
        for (const size_t offset : {1, 5, 9, 13, 17}) {
            CalibrationPages pages = whole;
            set(pages.color_parameters, offset, value);
            EXPECT_THAT(reason_for(pages), HasSubstr("colour camera parameters has ")) << offset;
        }
    }
    for (size_t offset = 21; offset < 101; offset += 4) {
        for (const float value : {std::numeric_limits<float>::quiet_NaN(), 100.5f, -1e6f}) {
            CalibrationPages pages = whole;
            set(pages.color_parameters, offset, value);
            EXPECT_THAT(reason_for(pages), HasSubstr("must be within -100 and 100")) << offset;
        }
    }
    CalibrationPages pages = whole;
    set(pages.depth_parameters, 0, 0.0f);
    EXPECT_EQ(reason_for(pages), "unit: the page of depth camera parameters has fx 0, must be within 180 and 730");
    pages = whole;
    pages.color_parameters[0] = 2;
    EXPECT_EQ(reason_for(pages), "unit: the page of colour camera parameters has version 2, must be 1");
}

TEST(Kinect2Calibration, SerialNumberOfControlCharactersIsHarmless) {
    CalibrationPages pages = pages_of(simulated_calibration());
    pages.serial = {'1', 0, 27, 0, 0xE4, 0, 'x', 0};
    EXPECT_EQ(parse_calibration(pages, "").serial, "1\\x1b?x");
}

}  // namespace
}  // namespace patina::sensor::kinect2::testing::calibration_test
