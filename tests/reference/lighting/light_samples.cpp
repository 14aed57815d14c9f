#include "tests/reference/lighting/light_samples.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include "tests/reference/reflectance/find_visibility.h"

namespace patina::reference {
namespace {

double brightness(const SeenColor& seen) { return (seen.color.r + seen.color.g + seen.color.b) / 3; }

}  // namespace

LightSample light_sample(std::span<const SeenColor> seen) {
    std::vector<SeenColor> sorted(seen.begin(), seen.end());
    std::ranges::stable_sort(sorted, {}, brightness);
    const size_t dark = std::max<size_t>(sorted.size() * 2 / 5, 1);
    LightSample sample;
    for (size_t i = 0; i < dark; ++i) sample.diffuse += sorted[i].color / static_cast<double>(dark);
    const double usual = brightness(sorted[sorted.size() * 3 / 10]);
    sample.to_viewer = sorted.back().direction;
    sample.excess = brightness(sorted.back()) - usual;
    sample.least_excess = 0.1 + 0.3 * usual;
    return sample;
}

TrialLight try_light(const Volume& volume, glm::dvec3 point_m, glm::dvec3 normal, glm::dvec3 lamp_m) {
    const double distance_m = glm::distance(point_m, lamp_m);
    const glm::dvec3 direction = (lamp_m - point_m) / distance_m;
    const double cosine = glm::dot(direction, normal);
    if (cosine <= 0.05) return {};
    const double above_m = 4 * volume.voxel_m, skipped_m = std::min(above_m / cosine, 16 * volume.voxel_m);
    const glm::dvec3 lift_m = normal * (above_m - skipped_m * cosine);
    const double end_m = distance_m - std::min(0.15, 0.3 * distance_m);
    TrialLight light{cosine / (std::numbers::pi * distance_m * distance_m), 1e3};
    if (end_m > skipped_m) {
        light.least_distance_m =
            least_distance_m(volume, point_m + lift_m + direction * skipped_m, point_m + lift_m + direction * end_m);
    }
    return light;
}

double sky_on_way_m(const std::set<std::array<int, 3>>& sky, double cell_m, glm::dvec3 point_m, glm::dvec3 normal,
                    glm::dvec3 direction, double reach_m) {
    constexpr double kStep_m = 0.001;
    double through_m = 0;
    for (double along_m = 0; along_m < reach_m; along_m += kStep_m) {
        const glm::dvec3 cell = glm::floor((point_m + along_m * direction) / cell_m);
        const double above = glm::dot(cell + 0.5 - point_m / cell_m, normal);
        const std::array<int, 3> key{static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z)};
        if (above > 1.5 && sky.contains(key)) through_m += kStep_m;
    }
    return through_m;
}

}  // namespace patina::reference
