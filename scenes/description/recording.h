#pragma once

#include <cstdint>

#include "patina/camera.h"

namespace patina::scenes {

/// A colour camera of its own beside the depth camera, without lens distortion.
struct ColorCamera {
    Intrinsics camera;
    RigidTransform color_from_depth{1.0};
};

/// How light is computed. Without area lights, bounces and an environment a pixel is the paper's Eq. 6, exactly;
/// otherwise these add their part as the mean of random samples.
struct RenderSettings {
    bool shadows = true;       ///< what stands between a light and a point darkens it; the paper knows no shadows (3.1)
    bool area_lights = false;  ///< lamps with a radius shine from all their surface, not from their centre
    uint32_t bounces = 0;      ///< how often light is reflected on its way beyond the reflection that the camera sees
    uint32_t samples = 64;     ///< random samples per pixel, where there is something to sample
    uint64_t seed = 0;
};

/// Named models of a sensor's errors; zeros are a perfect sensor that only quantises.
struct SensorNoise {
    /// Depth: a Gaussian of sigma = depth_constant_m + depth_quadratic_per_m * (z - depth_offset_m)^2.
    double depth_constant_m = 0;
    double depth_quadratic_per_m = 0;
    double depth_offset_m = 0;
    double flying_pixels = 0;  ///< share of the pixels at a depth edge that show a depth in between
    /// Colour, linear: a Gaussian of variance read^2 + shot * value, as of 1 / shot electrons at full scale.
    double color_read = 0;
    double color_shot = 0;
    /// Poses as recorded: Gaussians per axis; the true ones stay in truth/.
    double pose_translation_m = 0;
    double pose_rotation_rad = 0;
};

/// Which random numbers a frame's errors are: the same pair gives the same ones.
struct NoiseKey {
    uint64_t seed = 0;
    uint32_t frame = 0;
};

/// How a scene becomes a recording.
struct Recording {
    RenderSettings render;
    SensorNoise noise;
    bool exr = false;   ///< colour as linear OpenEXR without clipping rather than 8-bit sRGB
    uint64_t seed = 0;  ///< of noise
};

}  // namespace patina::scenes
