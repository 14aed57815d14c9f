#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "patina/camera.h"

namespace patina {

/// One pixel, whole groups, tails in both directions, and a Kinect v2's picture.
inline constexpr Extent2D kPictureExtents[] = {{1, 1}, {8, 8}, {13, 7}, {65, 33}, {512, 424}};

/// A camera that sees 70 degrees of width, off centre.
inline Intrinsics pinhole_camera(Extent2D extent) {
    const double focal = 0.7 * extent.width;
    return {extent, focal, focal * 1.01, extent.width * 0.49, extent.height * 0.52, {}};
}

/// The same with all five coefficients, of the size found in Kinects; the corners move by several pixels.
inline Intrinsics distorted_camera(Extent2D extent) {
    Intrinsics camera = pinhole_camera(extent);
    camera.distortion = {0.12, -0.27, 0.002, -0.001, 0.09};
    return camera;
}

/// Where a pinhole camera's pixel appears in the distorted picture.
inline glm::dvec2 distorted_px(const Intrinsics& camera, uint32_t x, uint32_t y) {
    return project(camera, {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1});
}

/// True within a thousandth of a pixel of a multiple of a half, where single and double precision may take different
/// pixels.
inline bool at_rounding_limit(glm::dvec2 px) {
    const auto near_half = [](double value) { return std::abs(value * 2 - std::round(value * 2)) < 2e-3; };
    return near_half(px.x) || near_half(px.y);
}

/// Depth in metres: a bumpy surface 1 to 2.5 m away with steps, and one pixel in ten without a reading.
inline Image<float> random_depth(Extent2D extent, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> bump(-0.004f, 0.004f);
    Image<float> depth_m(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const float step = (x / 6 + y / 5) % 3 == 0 ? 0.5f : 0.0f;
            const float slope = 1.0f + static_cast<float>(x) / static_cast<float>(extent.width);
            depth_m.at(x, y) = random() % 10 == 0 ? 0.0f : slope + step + bump(random);
        }
    }
    return depth_m;
}

}  // namespace patina
