#include "tests/reference/fusion/volume.h"

namespace patina::reference {

const Voxel* Volume::find(glm::ivec3 voxel) const {
    const glm::ivec3 block(glm::floor(glm::dvec3(voxel) / 8.0));
    const auto found = blocks.find({block.x, block.y, block.z});
    if (found == blocks.end()) return nullptr;
    const glm::ivec3 within = voxel - 8 * block;
    return &found->second[static_cast<size_t>(within.x + 8 * (within.y + 8 * within.z))];
}

glm::dvec3 Volume::center_m(const BlockCoordinates& block, int index) const {
    const glm::dvec3 within(index % 8, index / 8 % 8, index / 64);
    return (glm::dvec3(block[0], block[1], block[2]) * 8.0 + within + 0.5) * voxel_m;
}

std::optional<double> Volume::distance_at(glm::dvec3 point_m) const {
    const glm::dvec3 at = point_m / voxel_m - 0.5;
    const glm::dvec3 low = glm::floor(at);
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 corner(i & 1, i / 2 & 1, i / 4);
        const Voxel* voxel = find(glm::ivec3(low) + corner);
        if (!voxel || voxel->weight == 0) return {};
        const glm::dvec3 share = 1.0 - glm::abs(low + glm::dvec3(corner) - at);
        sum += share.x * share.y * share.z * voxel->sdf_m;
    }
    return sum;
}

}  // namespace patina::reference
