#include "sensor/camera_view.h"

#include <cmath>
#include <numbers>

namespace patina::sensor {

namespace {

constexpr double kDefaultFocal = 525.0 / 640;  // of the picture's width

bool is_view(double view_rad) { return view_rad > 0.01 && view_rad < 0.95 * std::numbers::pi; }

}  // namespace

Intrinsics intrinsics_of(Extent2D extent, const std::optional<glm::dvec2>& view_rad) {
    Intrinsics camera;
    camera.extent = extent;
    camera.cx = (extent.width - 1) / 2.0;
    camera.cy = (extent.height - 1) / 2.0;
    camera.fx = camera.fy = kDefaultFocal * extent.width;
    if (view_rad && is_view(view_rad->x) && is_view(view_rad->y)) {
        camera.fx = extent.width / (2 * std::tan(view_rad->x / 2));
        camera.fy = extent.height / (2 * std::tan(view_rad->y / 2));
    }
    return camera;
}

}  // namespace patina::sensor
