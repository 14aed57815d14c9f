#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <glm/glm.hpp>

#include "tests/reference/volume.h"

namespace patina::reference {

/// A voxel's label, 0 for none, and how sure it is.
struct VoxelLabel {
    uint32_t label = 0;
    uint32_t confidence = 0;

    bool operator==(const VoxelLabel&) const = default;
};

/// Labels of blocks of 8^3 voxels: x fastest, then y, then z.
struct LabelVolume {
    double voxel_m = 0;
    std::map<BlockCoordinates, std::vector<VoxelLabel>> blocks;

    /// That of the voxel which a world point lies in; none where there is no block.
    VoxelLabel at(glm::dvec3 point_m) const;
};

/// The label of a surface point: that of its voxel, else of the one three quarters of a voxel behind it, else before
/// it. `roots`: what became of each label, 0 where it was given up.
uint32_t sampled_label(const LabelVolume& volume, const std::vector<uint32_t>& roots, glm::dvec3 point_m,
                       glm::dvec3 normal);

/// A voxel's label after its merged and given up labels were replaced.
VoxelLabel relabelled(VoxelLabel known, const std::vector<uint32_t>& roots);

}  // namespace patina::reference
