#include "sensor/report_lines.h"

#include <cmath>

#include "engine/core/error.h"
#include "sensor/files/text_file.h"

namespace patina::sensor {

glm::dvec2 field_of_view_deg(const Intrinsics& camera) {
    const double horizontal = 2 * std::atan(0.5 * camera.extent.width / camera.fx);
    const double vertical = 2 * std::atan(0.5 * camera.extent.height / camera.fy);
    return glm::degrees(glm::dvec2(horizontal, vertical));
}

std::string camera_line(const Intrinsics& camera) {
    const glm::dvec2 view_deg = field_of_view_deg(camera);
    return text(camera.extent, ", fx ", camera.fx, " fy ", camera.fy, " cx ", camera.cx, " cy ", camera.cy, ", ",
                camera.distorted() ? "distorted" : "no distortion", ", field of view ", fixed(view_deg.x, 1), " x ",
                fixed(view_deg.y, 1), " degrees");
}

std::string offset_line(const RigidTransform& color_from_depth) {
    if (color_from_depth == RigidTransform(1.0)) return "registered to depth";
    return text(fixed(1000 * glm::length(glm::dvec3(color_from_depth[3])), 1), " mm from the depth camera");
}

std::string depth_units_line(double metres_per_unit, double max_metres) {
    return text(metres_per_unit, " m per unit, used up to ", max_metres, " m");
}

}  // namespace patina::sensor
