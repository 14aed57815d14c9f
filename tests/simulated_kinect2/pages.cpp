#include "tests/simulated_kinect2/pages.h"

#include <cmath>
#include <cstring>
#include <span>

#include "tests/simulated_kinect2/words.h"

namespace patina::sensor::kinect2::testing {
namespace {

constexpr size_t kPixels = 512 * 424;
constexpr uint16_t kBorder[] = {0x2C9A, 0x08EC, 0x42E8};

std::vector<uint16_t> phase_offsets(size_t frequency) {
    std::vector<uint16_t> table(kPixels);
    for (size_t y = 0; y < 424; ++y) {
        for (size_t x = 0; x < 512; ++x) {
            const double u = static_cast<double>(x) / 512, v = static_cast<double>(y) / 424;
            const double offset =
                9000.0 + 4000.0 * static_cast<double>(frequency) + 1500 * std::sin(3 * u + v) + 900 * v;
            table[512 * y + x] = x == 0 || x == 511 ? kBorder[frequency] : static_cast<uint16_t>(offset);
        }
    }
    return table;
}

std::vector<uint8_t> firmware_page() {
    std::vector<uint8_t> page;
    for (uint32_t record = 0; record < 7; ++record) {
        put(page, uint16_t{0});
        put(page, uint16_t{4});
        put(page, uint32_t{record == 3 ? 3911u : 1000u + record});
        put(page, uint32_t{0});
        put(page, uint32_t{0});
    }
    return page;
}

std::vector<uint8_t> serial_page(const std::string& serial) {
    std::vector<uint8_t> page;
    for (const char digit : serial) put(page, static_cast<uint16_t>(digit));
    page.resize(128);
    return page;
}

std::vector<uint8_t> depth_page(const DepthCamera& camera) {
    std::vector<uint8_t> page;
    for (const float value :
         {camera.fx, camera.fy, 0.0f, camera.cx, camera.cy, camera.k1, camera.k2, camera.p1, camera.p2, camera.k3}) {
        put(page, value);
    }
    page.resize(92);
    return page;
}

std::vector<uint8_t> color_page(const ColorCamera& camera) {
    std::vector<uint8_t> page{1};
    for (const float value : {camera.f, camera.cx, camera.cy, camera.shift_d, camera.shift_m}) put(page, value);
    for (const float factor : camera.mx) put(page, factor);
    for (const float factor : camera.my) put(page, factor);
    page.resize(12981);
    return page;
}

std::vector<uint8_t> p0_page(const Calibration& calibration) {
    std::vector<uint8_t> page;
    for (const uint32_t word : {32u, 3u, 2u, static_cast<uint32_t>(2 * kPixels), 2u, 12u, 286u, 8u}) put(page, word);
    for (const uint16_t frequency : {uint16_t{0}, uint16_t{1}, uint16_t{2}}) {
        put(page, static_cast<uint16_t>(frequency == 0 ? 80 : frequency == 1 ? 16 : 120));
        for (const uint16_t offset : calibration.p0[frequency]) put(page, offset);
        put(page, uint16_t{1});
    }
    page.resize(1302572 + 12 + 286 + 8);
    return page;
}

}  // namespace

Calibration simulated_calibration() {
    Calibration calibration;
    calibration.serial = "012345678901";
    calibration.firmware = "4.0.3911.0";
    calibration.depth = {365.402802f, 365.402802f, 260.925507f, 205.594604f, 0.095575f, -0.277055f, 0, 0, 0.097539f};
    calibration.color = {1081.372f, 959.5f, 539.5f, 863, 52, {}, {}};
    // An ideal pair: depth pixels, scaled by the two focal lengths; coordinates are in hundredths of a depth pixel.
    const float scale = 100 * 0.002199f * 1081.372f / 365.402802f;
    calibration.color.mx = {0, 0, 0, 0, 0, 0, 0, scale, 0, 0.002199f * 52 / 863 * 1081.372f};
    calibration.color.my = {0, 0, 0, 0, 0, 0, 0, 0, scale, 0};
    for (size_t f = 0; f < 3; ++f) calibration.p0[f] = phase_offsets(f);
    return calibration;
}

CalibrationPages pages_of(const Calibration& calibration) {
    return {firmware_page(), serial_page(calibration.serial), p0_page(calibration), depth_page(calibration.depth),
            color_page(calibration.color)};
}

}  // namespace patina::sensor::kinect2::testing
