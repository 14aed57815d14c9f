#include "tests/reference/reflectance/gather_irradiance.h"

#include <cmath>
#include <numbers>
#include <optional>

namespace patina::reference {

namespace {

glm::ivec3 voxel_at(const Volume& volume, glm::dvec3 point_m) {
    return glm::ivec3(glm::floor(point_m / volume.voxel_m));
}

/// The colour where the ray first meets a surface, of the voxel there or of one next to it.
std::optional<glm::dvec3> color_met(const Volume& volume, glm::dvec3 from_m, glm::dvec3 direction, double reach_m) {
    const double step_m = 0.25 * volume.voxel_m;
    for (double gone_m = 0; gone_m < reach_m; gone_m += step_m) {
        const Voxel* voxel = volume.find(voxel_at(volume, from_m + gone_m * direction));
        if (voxel == nullptr || voxel->weight == 0 || voxel->sdf_m > 0.5 * volume.voxel_m) continue;
        for (const double beside : {0.0, 1.0, -1.0}) {
            const glm::dvec3 at_m = from_m + (gone_m + beside * volume.voxel_m) * direction;
            const Voxel* colored = volume.find(voxel_at(volume, at_m));
            if (colored != nullptr && colored->colored) return colored->color;
        }
        return std::nullopt;
    }
    return std::nullopt;
}

}  // namespace

GatheredIrradiance gather_irradiance(const Volume& volume, glm::dvec3 point_m, glm::dvec3 normal, double lift_m,
                                     double reach_m, int rings) {
    const glm::dvec3 other = std::abs(normal.y) < 0.7 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(normal, other)), up = glm::cross(normal, right);
    GatheredIrradiance sum;
    double met = 0;
    for (int ring = 0; ring < rings; ++ring) {
        for (int turn = 0; turn < 2 * rings; ++turn) {
            const double sine = std::sqrt((ring + 0.5) / rings), cosine = std::sqrt(1 - sine * sine);
            const double angle = std::numbers::pi * (turn + 0.5) / rings;
            const glm::dvec3 direction = sine * (std::cos(angle) * right + std::sin(angle) * up) + cosine * normal;
            const auto color = color_met(volume, point_m + lift_m * normal, direction, reach_m);
            sum.mean += color.value_or(glm::dvec3(0));
            met += color ? 1 : 0;
        }
    }
    sum.missed = 1 - met / (2.0 * rings * rings);
    if (met > 0) sum.mean /= met;
    return sum;
}

}  // namespace patina::reference
