#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "passes/kinect2/decode_settings.h"
#include "passes/kinect2/tables.h"
#include "patina/frame.h"
#include "patina/image.h"

namespace patina::reference::kinect2 {

using patina::kinect2::CameraModel;
using patina::kinect2::DecodeSettings;
using patina::kinect2::Exponentials;

/// A phasor per pixel at 80, 16 and 120 MHz.
using Phasors = std::array<Image<glm::dvec2>, 3>;

struct Measured {
    Phasors phasors;
    Image<double> infrared;
};

struct Smoothed {
    Phasors phasors;
    Image<uint8_t> even;  ///< 0 where the phases around a pixel disagree
};

struct Unwrapped {
    Image<double> depth_mm;
    Image<double> amplitude;
};

/// The measurement that a code of 11 bits stands for; 32767 for the saturated one.
int measurement(uint32_t code);

/// What the passes compute, in double precision and straight from the sensor's description, without tables.
Measured measure_phases(const CameraModel& model, std::span<const uint8_t> infrared);
Smoothed smooth_phases(const Phasors& phasors, Exponentials exponentials);
Unwrapped unwrap_phases(const CameraModel& model, const Phasors& phasors, Exponentials exponentials);
Image<double> filter_edges(const Unwrapped& depth, const Image<uint8_t>& even, const DecodeSettings& settings);
/// Nearest pixels of the sensor's picture as the pinhole camera sees them, mirrored back.
Image<double> undistort(const CameraModel& model, const Image<double>& picture);

/// All of these: depth in metres.
Image<double> decode(const CameraModel& model, std::span<const uint8_t> infrared, const DecodeSettings& settings);

/// The place of a depth pixel in the colour picture, both mirrored back.
glm::dvec2 color_place(const CameraModel& model, uint32_t x, uint32_t y, double z_m);

/// Registered colour, with the window of 5 x 3 colour pixels around every depth pixel in a map as large as the colour
/// picture (libfreenect2): r | g << 8 | b << 16 | 255 << 24, or 0.
Image<uint32_t> register_color(const CameraModel& model, const Image<float>& depth_m, const Image<SrgbPixel>& color);

}  // namespace patina::reference::kinect2
