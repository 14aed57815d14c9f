#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "patina/camera.h"
#include "patina/image.h"
#include "sensor/kinect2/raw_frame.h"

namespace patina::scenes::kinect2 {

inline constexpr Extent2D kInfraredExtent{512, 424};
inline constexpr size_t kRowBytes = 704;  ///< 512 codes of 11 bits
using sensor::kinect2::kSubImageBytes;
using sensor::kinect2::kSubImages;
inline constexpr uint16_t kSaturatedCode = 1024;

/// What decides how a scene appears in a Kinect v2's infrared frames.
struct InfraredSensor {
    Intrinsics camera;  ///< 512 x 424, with lens distortion; pixels as transmitted, mirrored left to right
    /// Phase offsets at 80, 16 and 120 MHz in units of 1 / 65536 turn: 512 x 424 each, rows from the top.
    std::array<std::vector<uint16_t>, 3> p0;
};

/// What each pixel of the sensor sees, as transmitted.
struct InfraredScene {
    Image<float> depth_m;    ///< along the optical axis; 0: no light returns
    Image<float> amplitude;  ///< of the modulated light, in units of measurements (at most 16320 fit)
};

/// Gaussian noise on every measurement, with the variance floor + per_amplitude * amplitude: of the electronics, and of
/// photons.
struct MeasurementNoise {
    double floor = 0;
    double per_amplitude = 0;
    uint64_t seed = 1;
};

/// The code nearest to a measurement: 1024 steps in eight octaves, with a sign; kSaturatedCode beyond 16320.
uint16_t encode(double measurement);

/// A row of 512 codes as it is transmitted, every fourth one first. The first and the last one carry no data, and
/// become 0.
std::array<uint8_t, kRowBytes> pack_row(std::span<const uint16_t, 512> codes);

/// Millimetres that light travels to a point at depth z_mm on the undistorted ray (x, y, 1), and back: the inverse of
/// the decoder's geometry, whose emitter is beside the camera.
double travel_mm(glm::dvec2 ray, double z_mm);

/// An infrared frame as the sensor would send it: kSubImages * kSubImageBytes bytes. Three phases of three modulation
/// frequencies; the last sub-image, ambient light, is 0. Pixels whose ray the lens model does not have are dark. Throws
/// Error when a picture or a table has another size.
std::vector<uint8_t> infrared_frame(const InfraredSensor& sensor, const InfraredScene& scene,
                                    const MeasurementNoise& noise = {});

/// What the sensor sees of a picture that a pinhole camera at its place rendered, mirrored and distorted; each pixel is
/// the nearest of the picture, 0 outside of it.
Image<float> as_transmitted(const Intrinsics& sensor, const Image<float>& picture, const Intrinsics& pinhole);

/// Amplitudes of surfaces under the sensor's own light: strength * reflectance / z^2, 0 where there is no depth.
/// `strength` is the amplitude of a white surface 1 m away.
Image<float> lit_amplitude(const Image<float>& depth_m, const Image<float>& reflectance, double strength);

}  // namespace patina::scenes::kinect2
