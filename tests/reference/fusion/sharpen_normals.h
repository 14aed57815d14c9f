#pragma once

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::reference {

/// What one camera sees of a surface: world positions (w: depth, 0: nothing) and unit normals, 0 where unknown.
struct SeenSurface {
    Image<glm::dvec4> position_m;
    Image<glm::dvec3> normal;
};

/// What add_sharpen_normals computes.
Image<glm::dvec3> sharpen_normals(const SeenSurface& seen, double focal_px, double voxel_m);

}  // namespace patina::reference
