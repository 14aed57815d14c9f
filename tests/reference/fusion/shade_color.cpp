#include "tests/reference/fusion/shade_color.h"

#include <cmath>

namespace patina::reference {

glm::dvec4 color_at(const Volume& volume, glm::dvec3 point_m) {
    const glm::dvec3 at = point_m / volume.voxel_m - 0.5;
    glm::dvec4 sum(0);
    for (int dz = 0; dz <= 1; ++dz) {
        for (int dy = 0; dy <= 1; ++dy) {
            for (int dx = 0; dx <= 1; ++dx) {
                const glm::ivec3 voxel = glm::ivec3(glm::floor(at)) + glm::ivec3(dx, dy, dz);
                const Voxel* found = volume.find(voxel);
                if (!found || !found->colored) continue;
                const glm::dvec3 distance = glm::abs(at - glm::dvec3(voxel));
                const double share = (1 - distance.x) * (1 - distance.y) * (1 - distance.z);
                sum += glm::dvec4(found->color, 1) * share;
            }
        }
    }
    return sum.w > 0 ? sum / sum.w : glm::dvec4(0);
}

}  // namespace patina::reference
