#pragma once

#include <optional>

#include "tests/reference/fusion/measure_slope.h"
#include "tests/reference/fusion/volume.h"

namespace patina::reference {

/// One frame as the fusion sees it.
struct Observation {
    Intrinsics camera;
    RigidTransform world_from_camera;
    Image<float> depth_m;  ///< 0: no reading
    Image<Slope> slope;
    struct Color {
        Intrinsics camera;
        RigidTransform world_from_camera;
        Image<glm::vec4> linear;  ///< a = 0: no reading
    };
    std::optional<Color> color;
};

struct Fusion {
    double truncation_m = 0;
    double truncation_slope = 0;
    double max_depth_m = 0;
    double frontal_weight = 16;  ///< what a sample of a surface that faces the camera adds
    double max_weight = 0;
    double color_band_m = 0;
    double max_color_weight = 0;
    double settled_weight = 0;         ///< of a voxel whose colour can wait
    uint32_t settled_color_every = 1;  ///< frames from turn to turn of a block of such voxels
    uint32_t color_frame = 0;          ///< frames with colour before this one
};

/// What add_integrate makes of one voxel, in double precision and without rounding of what is stored, if its block has
/// its turn to take colour.
Voxel integrate(const Voxel& voxel, glm::dvec3 center_m, const Observation& seen, const Fusion& fusion);

/// The same for all voxels of a volume. A block whose
/// voxels near the surface are all settled takes colour when the sum of its coordinates, 2560 (as keys have none below
/// zero), and color_frame is a multiple of settled_color_every, others do in every frame. Returns how many blocks with
/// voxels near the surface had to wait.
size_t integrate(Volume& volume, const Observation& seen, const Fusion& fusion);

}  // namespace patina::reference
