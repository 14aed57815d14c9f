#include "tests/reference/texture/detail.h"

namespace patina::reference {

glm::dvec3 detail_normal(const Volume& volume, const PlacedTexel& texel, glm::dvec4 tangent) {
    constexpr glm::dvec3 kFlat(0, 0, 1);
    glm::dvec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0);
        step[axis] = volume.voxel_m;
        const auto after = volume.distance_at(texel.position_m + step);
        const auto before = volume.distance_at(texel.position_m - step);
        if (!after || !before) return kFlat;
        slope[axis] = *after - *before;
    }
    if (glm::length(slope) == 0) return kFlat;
    const glm::dvec3 z = glm::normalize(texel.normal), x = glm::normalize(glm::dvec3(tangent));
    const glm::dvec3 y = glm::cross(z, x) * tangent.w;
    // By Cramer's rule, as x and z need not be at right angles.
    const double volume_of = glm::dot(glm::cross(x, y), z);
    const glm::dvec3 seen(glm::dot(glm::cross(slope, y), z), glm::dot(glm::cross(x, slope), z),
                          glm::dot(glm::cross(x, y), slope));
    const glm::dvec3 unit = glm::normalize(seen / volume_of);
    return unit.z < 0.5 ? kFlat : unit;
}

}  // namespace patina::reference
