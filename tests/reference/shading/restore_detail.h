#pragma once

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::reference {

/// What one camera sees of a model with reflectance, and the settings of the pass.
struct DetailView {
    Image<glm::dvec4> position_m, normal, color, light, kd, picture_kd, rgb, ks_alpha;
    double focal_px = 0, voxel_m = 0;
};

struct Detailed {
    Image<glm::dvec4> kd, rgb;
};

/// What add_restore_detail computes.
Detailed restore_detail(const DetailView& view);

}  // namespace patina::reference
