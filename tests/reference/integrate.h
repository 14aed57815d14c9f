#pragma once

#include <optional>

#include "tests/reference/measure_slope.h"
#include "tests/reference/volume.h"

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
};

/// What add_integrate makes of one voxel, in double precision and without rounding of what is stored.
Voxel integrate(const Voxel& voxel, glm::dvec3 center_m, const Observation& seen, const Fusion& fusion);

/// The same for all voxels of a volume.
void integrate(Volume& volume, const Observation& seen, const Fusion& fusion);

}  // namespace patina::reference
