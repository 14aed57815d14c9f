#include "export/photometric.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/core/latitude_longitude.h"
#include "engine/core/luminance.h"

namespace patina {

namespace {

/// Nearer surface counts as if it were so far away: it belongs to the lamp.
constexpr double kNearestLamp_m = 0.1;

/// Irradiance, in linear pixel values times pi.
double irradiance(const Light& light, const Patch& patch) {
    const glm::dvec3 to_light_m = light.position_m - glm::dvec3(patch.center_m), area_m2(patch.area_m2);
    const double distance_m = std::max({glm::length(to_light_m), light.radius_m, kNearestLamp_m});
    const double cosine = glm::dot(to_light_m, area_m2) / (distance_m * glm::length(area_m2));
    return luminance(intensity_towards(light, glm::dvec3(patch.center_m))) * std::max(cosine, 0.0) /
           (distance_m * distance_m);
}

double with_six_digits(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 5);
    return std::round(value / unit) * unit;
}

}  // namespace

double candela_per_intensity(std::span<const Light> lights, std::span<const Patch> patches) {
    double area_m2 = 0, power = 0;
    for (const Patch& patch : patches) {
        const double own_m2 = glm::length(glm::dvec3(patch.area_m2));
        area_m2 += own_m2;
        for (const Light& light : lights) power += irradiance(light, patch) * own_m2;
    }
    return power > 0 ? with_six_digits(kMeanIlluminance_lux * area_m2 / power) : 1;
}

double luminance_per_pixel_value(const Image<glm::vec3>& environment) {
    return with_six_digits(kMeanIlluminance_lux / (std::numbers::pi * mean_luminance(environment)));
}

}  // namespace patina
