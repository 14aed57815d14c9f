#include "sensor/kinect2/calibration.h"

#include <initializer_list>
#include <span>

#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "sensor/kinect2/little_endian.h"

namespace patina::sensor::kinect2 {
namespace {

constexpr size_t kFirmwareRecord = 16;
constexpr size_t kMainApplication = 3;
constexpr size_t kPixels = size_t{kInfraredWidth} * kInfraredHeight;
constexpr size_t kP0Header = 32;
/// Of the colour polynomials; those of units stay below 1.
constexpr float kMostFactor = 100;
constexpr size_t kP0Stride = 2 + 2 * kPixels + 2;  // frequency, table, AB multiplier

class Page {
  public:
    Page(const char* what, const std::vector<uint8_t>& bytes, size_t least, const std::string& name)
        : what_(what), bytes_(bytes), name_(name) {
        if (bytes.size() < least) fail("has ", bytes.size(), " bytes, must have ", least);
    }

    template <class T>
    T at(size_t offset) const {
        return read_at<T>(bytes_, offset);
    }

    float within(size_t offset, const char* field, float low, float high) const {
        const auto value = at<float>(offset);
        if (!(value >= low && value <= high)) fail("has ", field, " ", value, ", must be within ", low, " and ", high);
        return value;
    }

    template <class... Parts>
    [[noreturn]] void fail(const Parts&... parts) const {
        throw Error(name_, ": the page of ", what_, " ", parts...);
    }

  private:
    const char* what_;
    std::span<const uint8_t> bytes_;
    const std::string& name_;
};

std::string parse_firmware(const Page& page) {
    const size_t record = kMainApplication * kFirmwareRecord;
    return text(page.at<uint16_t>(record + 2), ".", page.at<uint16_t>(record), ".", page.at<uint32_t>(record + 4), ".",
                page.at<uint32_t>(record + 8));
}

std::string parse_serial(const std::vector<uint8_t>& page) {
    std::string serial;
    for (size_t i = 0; i + 1 < page.size(); i += 2) {
        const auto unit = read_at<uint16_t>(page, i);
        if (unit == 0) break;
        serial.push_back(unit < 0x80 ? static_cast<char>(unit) : '?');
    }
    return printable(serial);
}

/// Half to twice what units have, so that an absurd value is not taken for a lens.
DepthCamera parse_depth(const Page& page) {
    DepthCamera camera;
    camera.fx = page.within(0, "fx", 180, 730);
    camera.fy = page.within(4, "fy", 180, 730);
    camera.cx = page.within(12, "cx", 0, kInfraredWidth);
    camera.cy = page.within(16, "cy", 0, kInfraredHeight);
    camera.k1 = page.within(20, "k1", -10, 10);
    camera.k2 = page.within(24, "k2", -10, 10);
    camera.p1 = page.within(28, "p1", -1, 1);
    camera.p2 = page.within(32, "p2", -1, 1);
    camera.k3 = page.within(36, "k3", -10, 10);
    return camera;
}

ColorCamera parse_color(const Page& page) {
    if (page.at<uint8_t>(0) != 1) page.fail("has version ", int{page.at<uint8_t>(0)}, ", must be 1");
    ColorCamera camera;
    camera.f = page.within(1, "f", 540, 2160);
    camera.cx = page.within(5, "cx", 0, kColorWidth);
    camera.cy = page.within(9, "cy", 0, kColorHeight);
    camera.shift_d = page.within(13, "shift_d", 1, 10000);
    camera.shift_m = page.within(17, "shift_m", -1000, 1000);
    for (size_t i = 0; i < camera.mx.size(); ++i) {
        camera.mx[i] = page.within(21 + 4 * i, "mx", -kMostFactor, kMostFactor);
        camera.my[i] = page.within(61 + 4 * i, "my", -kMostFactor, kMostFactor);
    }
    return camera;
}

std::vector<uint16_t> parse_p0(const std::vector<uint8_t>& page, size_t frequency) {
    std::vector<uint16_t> table(kPixels);
    std::memcpy(table.data(), page.data() + kP0Header + kP0Stride * frequency + 2, 2 * kPixels);
    return table;
}

}  // namespace

Calibration parse_calibration(const CalibrationPages& pages, const std::string& name) {
    Calibration calibration;
    calibration.firmware =
        parse_firmware(Page("firmware versions", pages.firmware, (kMainApplication + 1) * kFirmwareRecord, name));
    calibration.serial = parse_serial(pages.serial);
    calibration.depth = parse_depth(Page("depth camera parameters", pages.depth_parameters, 40, name));
    calibration.color = parse_color(Page("colour camera parameters", pages.color_parameters, 101, name));
    // No driver reads the words of the header, so none of them is a reason to refuse a sensor.
    const Page p0("phase offsets", pages.p0_tables, kP0Header + calibration.p0.size() * kP0Stride, name);
    for (size_t f = 0; f < calibration.p0.size(); ++f) calibration.p0[f] = parse_p0(pages.p0_tables, f);
    return calibration;
}

}  // namespace patina::sensor::kinect2
