#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "tests/reference/fusion/measure_slope.h"

namespace patina::reference {

/// One observation: the direction from the surface to the colour camera, and the colour seen from there.
struct SeenColor {
    glm::dvec3 direction{0};
    glm::dvec3 color{0};
    std::array<bool, 3> clipped{};
    int samples = 1;
};

/// What is known of one voxel.
struct ObservedVoxel {
    glm::dvec3 normal{0};
    double offset_vox = 0;  ///< along the normal, from the voxel's centre to its surface
    int surface_samples = 0;
    std::vector<SeenColor> seen;
    uint32_t label = 0;
    int confidence = 0;
};

/// One frame as the collection sees it.
struct ObservedFrame {
    Intrinsics depth_camera;
    RigidTransform world_from_depth;
    Image<glm::vec4> position_m;  ///< of the model; w: depth
    Image<glm::vec4> normal;
    Image<float> depth_m;
    Image<Slope> slope;
    Intrinsics color_camera;
    RigidTransform world_from_color;
    Image<glm::vec4> color;
    Image<uint32_t> labels;                       ///< empty: none
    RigidTransform world_from_color_before{1.0};  ///< at the frame before
    double shutter_share = 0;                     ///< of the time since then, that the shutter was open
};

struct ObservationRules {
    double voxel_m = 0;
    double max_distance_m = 0;
    double max_angle_degrees = 0;
    double depth_tolerance_m = 0;
    double depth_tolerance_per_m2 = 0;
    double merge_angle_degrees = 0;
    int edge_margin_px = 0;
    uint32_t stride_px = 1;
    glm::uvec2 phase{0};
    SlopeJump jump;
    double max_blur_px = 0;
    size_t smeared_observations = 0;  ///< with fewer, max_blur_px does not count
};

/// The voxels that add_allocate_records lists.
std::set<std::array<int, 3>> seen_voxels(const ObservedFrame& frame, const ObservationRules& rules);

/// What add_update_records makes of one voxel of those, in double precision and without rounding of what is stored.
void observe(ObservedVoxel& voxel, glm::ivec3 coordinates, const ObservedFrame& frame, const ObservationRules& rules);

}  // namespace patina::reference
