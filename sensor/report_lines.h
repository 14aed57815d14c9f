#pragma once

#include <string>

#include <glm/glm.hpp>

#include "patina/camera.h"

namespace patina::sensor {

// Lines that the reports of recordings and of scenes have in common.

/// Horizontal and vertical, lens distortion left aside.
glm::dvec2 field_of_view_deg(const Intrinsics& camera);

/// "512 x 424, fx 365 fy 365 cx 255.5 cy 211.5, no distortion, field of view 70.1 x 60.3 degrees"
std::string camera_line(const Intrinsics& camera);

/// "registered to depth", or how far apart the two cameras are.
std::string offset_line(const RigidTransform& color_from_depth);

/// "0.001 m per unit, used up to 8 m"
std::string depth_units_line(double metres_per_unit, double max_metres);

}  // namespace patina::sensor
