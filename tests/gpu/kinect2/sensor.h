#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "passes/kinect2/tables.h"
#include "scenes/kinect2/infrared_frame.h"

namespace patina {

/// A Kinect v2 as devices describe themselves, with phase offsets that vary smoothly.
inline kinect2::CameraModel test_camera() {
    kinect2::CameraModel model;
    model.depth = {kinect2::kInfraredExtent, 365.402802,       365.402802,
                   260.925507 - 0.5,         205.594604 - 0.5, {0.095575, -0.277055, 0, 0, 0.097539}};
    model.color = {1081.372, 959.5, 539.5, 863, 52, {}, {}};
    model.color.mx = {4.4929e-4,  1.9166e-5, 4.8291e-5, 3.5367e-4, -2.4404e-5,
                      -1.1943e-5, 9.8843e-4, 0.642474,  5.0065e-3, 0.142021};
    model.color.my = {4.4279e-6, 7.2486e-4,  3.9856e-4,  4.9038e-5, 1.3602e-4,
                      1.0729e-3, -1.7547e-5, -5.5426e-3, 0.641807,  0.0180811};
    const uint32_t start[] = {0x2C9A, 0x08EC, 0x42E8};
    for (uint32_t f = 0; f < 3; ++f) {
        for (uint32_t y = 0; y < 424; ++y) {
            for (uint32_t x = 0; x < 512; ++x) {
                const bool at_side = x == 0 || x == 511;
                model.p0[f].push_back(static_cast<uint16_t>(at_side ? start[f] : start[f] + 3 * x + (5 + f) * y));
            }
        }
    }
    return model;
}

/// The same for the simulation.
inline scenes::kinect2::InfraredSensor simulated(const kinect2::CameraModel& model) { return {model.depth, model.p0}; }

/// A picture of f(x, y), as the sensor's pixels are transmitted.
inline Image<float> picture_of(const std::function<double(uint32_t, uint32_t)>& f) {
    Image<float> picture(kinect2::kInfraredExtent);
    for (uint32_t y = 0; y < 424; ++y) {
        for (uint32_t x = 0; x < 512; ++x) picture.at(x, y) = static_cast<float>(f(x, y));
    }
    return picture;
}

/// A room with steps, slopes, dark stripes, a saturated patch, and what is too far or returns no light.
inline scenes::kinect2::InfraredScene cluttered_scene() {
    const auto depth = [](uint32_t x, uint32_t y) -> double {
        if (x / 40 == 3 && y > 200) return 0;
        if (x / 40 == 7) return 5.5;
        return 0.6 + 0.5 * ((x / 50 + y / 40) % 5) + 0.001 * x + 0.0007 * y;
    };
    const auto amplitude = [&](uint32_t x, uint32_t y) -> double {
        if (x / 16 == 20 && y / 16 == 10) return 30000;
        const double reflectance = y / 30 % 6 == 5 ? 0.02 : 0.3 + 0.3 * std::sin(0.05 * x) * std::cos(0.03 * y);
        const double z = depth(x, y);
        return z > 0 ? 900 * reflectance / (z * z) : 0;
    };
    return {picture_of(depth), picture_of(amplitude)};
}

}  // namespace patina
