#pragma once

#include "patina/camera.h"

namespace patina::reference {

struct Slope {
    glm::dvec2 depth_per_px{0};  ///< metres
    double plane_factor = 0;   ///< distance from the tangent plane per difference of depths; 0 where there is no plane
    bool beside_edge = false;  ///< one of the eight pixels around belongs to a nearer surface
};

/// Two depths belong to different surfaces when they differ by more than floor_m + relative * depth.
struct SlopeJump {
    double floor_m = 0.01;
    double relative = 0.015;
};

/// What add_measure_slope computes, without its rounding.
Image<Slope> measure_slope(const Image<float>& depth_m, const Intrinsics& camera, const SlopeJump& jump = {});

/// A slope rounded as 11 + 11 + 9 + 1 bits hold it.
Slope rounded(const Slope& slope);

}  // namespace patina::reference
