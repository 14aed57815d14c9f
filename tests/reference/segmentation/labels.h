#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "tests/reference/fusion/volume.h"

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

/// The label of a pixel: the root of what the map said there, where that is one; else its segment's.
uint32_t pixel_label(uint32_t map_label, uint32_t segment, const std::vector<uint32_t>& roots,
                     const std::vector<uint32_t>& segment_labels);

/// One frame's labels, and the model as its camera sees it.
struct LabelledView {
    Intrinsics camera;
    RigidTransform world_from_camera;
    Image<glm::vec4> position_m;
    Image<glm::vec4> normal;
    Image<uint32_t> segment;               ///< of every stride-th pixel in x and y; 0: none
    std::vector<uint32_t> segment_labels;  ///< by segment
    double voxel_m = 0;
    int stride = 1;
};

/// The label that a view gives a voxel near the surface: of the pixel nearest to where its centre is seen, where the
/// surface there passes within a voxel of it, or two if it has no label, and is not seen at a grazing angle. Where
/// there are segments of some pixels only: else of the other three around, beside it, below or above, across. 0: none.
uint32_t seen_label(const LabelledView& view, glm::dvec3 center_m, const VoxelLabel& known);

/// A voxel's label after a vote for another one, or its own.
VoxelLabel voted(VoxelLabel known, uint32_t label);

}  // namespace patina::reference
