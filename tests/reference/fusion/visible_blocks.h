#pragma once

#include <array>
#include <map>

#include "patina/camera.h"

namespace patina::reference {

/// What one camera can see.
struct ViewVolume {
    Intrinsics camera;
    RigidTransform world_from_camera;
    double near_m = 0;
    double far_m = 0;
};

struct DepthRange {
    double near_m = 0;
    double far_m = 0;
};

/// Probes a cube by 9^3 points: for each tile of `tile_px` pixels in which one of them appears, the range of their
/// depths. Empty where none is in view.
std::map<std::array<int, 2>, DepthRange> seen_tiles(const ViewVolume& view, int tile_px, glm::dvec3 low_m,
                                                    double edge_m);

/// Whether a ball lies outside one of the six planes around what the camera sees, and so certainly out of view.
bool outside_view(const ViewVolume& view, glm::dvec3 center_m, double radius_m);

}  // namespace patina::reference
