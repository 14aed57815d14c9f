#include "tests/reference/labels.h"

#include <cmath>

namespace patina::reference {

VoxelLabel LabelVolume::at(glm::dvec3 point_m) const {
    BlockCoordinates block{};
    size_t index = 0;
    for (size_t i = 3; i-- > 0;) {
        const int voxel = static_cast<int>(std::floor(point_m[static_cast<int>(i)] / voxel_m));
        block[i] = static_cast<int>(std::floor(voxel / 8.0));
        index = index * 8 + static_cast<size_t>(voxel - 8 * block[i]);
    }
    const auto found = blocks.find(block);
    return found == blocks.end() ? VoxelLabel{} : found->second[index];
}

uint32_t sampled_label(const LabelVolume& volume, const std::vector<uint32_t>& roots, glm::dvec3 point_m,
                       glm::dvec3 normal) {
    for (const double along_vox : {0.0, -0.75, 0.75}) {
        const uint32_t label = roots.at(volume.at(point_m + normal * along_vox * volume.voxel_m).label);
        if (label != 0) return label;
    }
    return 0;
}

VoxelLabel relabelled(VoxelLabel known, const std::vector<uint32_t>& roots) {
    const uint32_t root = roots.at(known.label);
    return root == 0 ? VoxelLabel{} : VoxelLabel{root, known.confidence};
}

}  // namespace patina::reference
