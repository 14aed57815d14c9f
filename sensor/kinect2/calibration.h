#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sensor/kinect2/raw_frame.h"

namespace patina::sensor::kinect2 {

/// What a device answers about itself, byte for byte. The phase offsets hold for the one run of the stream before which
/// they were read, so that a recording of raw frames keeps these pages beside it.
struct CalibrationPages {
    std::vector<uint8_t> firmware;          ///< 16-byte records {u16 minor, u16 major, u32 revision, u32 build, u32 0}
    std::vector<uint8_t> serial;            ///< page 1: UTF-16LE, zero padded
    std::vector<uint8_t> p0_tables;         ///< page 2
    std::vector<uint8_t> depth_parameters;  ///< page 3
    std::vector<uint8_t> color_parameters;  ///< page 4
};

/// The depth camera in pixels of its 512 x 424 image. Distorted x = x (1 + k1 r2 + k2 r2^2 + k3 r2^3) + p2 (r2 + 2 x^2)
/// + 2 p1 x y, y with p1 and p2 exchanged.
struct DepthCamera {
    float fx = 0, fy = 0, cx = 0, cy = 0;
    float k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
};

/// The colour camera in pixels of its 1920 x 1080 image, and the polynomials that lead there from depth pixels.
struct ColorCamera {
    float f = 0, cx = 0, cy = 0;
    float shift_d = 0;  ///< nominal depth, mm
    float shift_m = 0;  ///< distance of the two cameras, mm
    /// Factors of u^3, v^3, u^2 v, u v^2, u^2, v^2, u v, u, v, 1.
    std::array<float, 10> mx{}, my{};
};

/// A device's calibration, parsed and checked.
struct Calibration {
    std::string serial;    ///< 12 digits
    std::string firmware;  ///< of the main application: "4.0.3911.0"
    DepthCamera depth;
    ColorCamera color;
    /// Phase offsets at 80, 16 and 120 MHz in units of 1/65536 turn: kInfraredWidth * kInfraredHeight each, row by row,
    /// top row first. Columns 0 and 511 hold constants.
    std::array<std::vector<uint16_t>, 3> p0;
};

/// Parses pages 1 to 4 and the firmware versions. `name` is the device or the file that they come from, for messages.
/// Throws Error when a page is too short, its sizes are not this sensor's, or a number is not finite or absurd, such as
/// a focal length of 0.
Calibration parse_calibration(const CalibrationPages& pages, const std::string& name);

}  // namespace patina::sensor::kinect2
