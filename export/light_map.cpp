#include "export/light_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "engine/core/latitude_longitude.h"

namespace patina {

namespace {

constexpr double kNearest_m = 0.1;  // a lamp in the point itself counts as if it were so far away
constexpr double kPi = std::numbers::pi;

/// A pixel that a lamp covers.
struct Covered {
    size_t pixel;
    double solid_angle;
};

/// The environment's radiance from a direction in glTF's axes.
glm::vec3 from_afar(const SceneParts& scene, glm::dvec3 direction) {
    if (scene.environment.empty()) return glm::vec3(scene.ambient);
    const glm::dvec3 in_picture = glm::normalize(scene.environment_from_gltf * direction);
    return scene.environment.pixels()[pixel_of_direction(in_picture, scene.environment.extent())];
}

}  // namespace

void add_to_map(const Light& light, glm::dvec3 from_m, Image<glm::vec3>& map) {
    const Extent2D extent = map.extent();
    const glm::dvec3 offset_m = light.position_m - from_m;
    const double distance_m = std::max(glm::length(offset_m), kNearest_m);
    const glm::dvec3 towards = glm::length(offset_m) > 0 ? glm::normalize(offset_m) : glm::dvec3(0, 1, 0);
    const double least = 2 * kPi / extent.width;  // a pixel's width: the disc's radius
    const double radius = std::max(std::asin(std::min(light.radius_m / distance_m, 1.0)), least);
    std::vector<Covered> covered;
    double sum = 0;
    const double tilt = std::asin(std::clamp(towards.y, -1.0, 1.0));
    for (uint32_t y = 0; y < extent.height; ++y) {
        if (std::abs(kPi * (0.5 - (y + 0.5) / extent.height) - tilt) > radius + least) continue;
        for (uint32_t x = 0; x < extent.width; ++x) {
            if (glm::dot(direction_of_place({x + 0.5, y + 0.5}, extent), towards) < std::cos(radius)) continue;
            covered.push_back({size_t{y} * extent.width + x, solid_angle_of_row(y, extent)});
            sum += covered.back().solid_angle;
        }
    }
    const glm::vec3 radiance(intensity_towards(light, from_m) / (distance_m * distance_m * sum));
    for (const Covered& each : covered) map.pixels()[each.pixel] += radiance;
}

Image<glm::vec3> light_map(const SceneParts& scene, glm::dvec3 from_m, Extent2D extent) {
    Image<glm::vec3> map(extent);
    for (uint32_t y = 0; y < extent.height; ++y)
        for (uint32_t x = 0; x < extent.width; ++x)
            map.at(x, y) = from_afar(scene, direction_of_place({x + 0.5, y + 0.5}, extent));
    for (const Light& light : scene.lights) add_to_map(light, from_m, map);
    return map;
}

}  // namespace patina
