#pragma once

#include <glm/glm.hpp>

#include "patina/camera.h"

namespace patina::tools {

/// Where a view is seen from along the axes of the scene.
enum class AxisView { kFront, kBack, kRight, kLeft, kTop, kBottom };

/// A camera that looks at a point from a distance, and is moved as in Blender: on a turntable, never rolled. Its front
/// is the side from which the scene was first seen.
class FreeCamera {
  public:
    static constexpr double kLeastDistance_m = 0.05, kMostDistance_m = 100;

    FreeCamera() { set_up({0, -1, 0}, {0, 0, 1}); }

    /// `up`: of any length but 0; `forward`: the direction of a view from the front. The camera looks that way.
    void set_up(glm::dvec3 up, glm::dvec3 forward);

    /// Looks from where a pose (world_from_camera) does, but for its roll, at what is `distance_m` before it.
    void look_from(const RigidTransform& pose, double distance_m);

    /// Turns around the point by so many pixels of the mouse: 0.4 degrees each, as Blender does.
    void orbit(glm::dvec2 moved_px);
    /// Moves along the picture, so that the point follows the mouse; `focal_px`: of the camera.
    void pan(glm::dvec2 moved_px, double focal_px);
    /// Comes nearer (above 0) by a sixth a step, or goes away.
    void dolly(double steps);
    void look_along(AxisView view);
    /// Turns to what lies behind the point.
    void opposite();

    glm::dvec3 pivot_m() const { return pivot_m_; }
    void set_pivot(glm::dvec3 pivot_m) { pivot_m_ = pivot_m; }
    double distance_m() const { return distance_m_; }

    /// world_from_camera.
    RigidTransform pose() const;

  private:
    glm::dvec3 towards_camera() const;
    glm::dvec3 right() const;

    glm::dvec3 up_{0, -1, 0}, ahead_{0, 0, -1}, aside_{1, 0, 0};  ///< of the turntable: ahead_ leads to the front
    glm::dvec3 pivot_m_{0};
    double distance_m_ = 2;
    double azimuth_ = 0, elevation_ = 0;  ///< radians, of the camera as seen from the point
};

/// A pinhole camera whose picture is as high as `field_of` sees; the vertical field of view stays.
Intrinsics with_extent(const Intrinsics& field_of, Extent2D extent);

}  // namespace patina::tools
