#include "engine/core/latitude_longitude.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/luminance.h"

namespace patina {

namespace {

constexpr double kPi = std::numbers::pi;

}  // namespace

glm::dvec3 direction_of_place(glm::dvec2 place_px, Extent2D extent) {
    const double turn = 2 * kPi * (place_px.x / extent.width - 0.5), tilt = kPi * (0.5 - place_px.y / extent.height);
    return {std::cos(tilt) * std::cos(turn), std::sin(tilt), std::cos(tilt) * std::sin(turn)};
}

size_t pixel_of_direction(glm::dvec3 direction, Extent2D extent) {
    const double turn = std::atan2(direction.z, direction.x) / (2 * kPi) + 0.5;
    const double tilt = 0.5 - std::asin(std::clamp(direction.y, -1.0, 1.0)) / kPi;
    const auto x = std::min(static_cast<uint32_t>(turn * extent.width), extent.width - 1);
    const auto y = std::min(static_cast<uint32_t>(tilt * extent.height), extent.height - 1);
    return size_t{y} * extent.width + x;
}

double solid_angle_of_row(uint32_t row, Extent2D extent) {
    const double step = kPi / extent.height;
    return 2 * kPi / extent.width * (std::cos(row * step) - std::cos((row + 1) * step));
}

double mean_luminance(const Image<glm::vec3>& picture) {
    const Extent2D extent = picture.extent();
    double sum = 0;
    for (uint32_t y = 0; y < extent.height; ++y) {
        double row = 0;
        for (uint32_t x = 0; x < extent.width; ++x) row += luminance(glm::dvec3(picture.at(x, y)));
        sum += row * solid_angle_of_row(y, extent);
    }
    return sum / (4 * kPi);
}

}  // namespace patina
