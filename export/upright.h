#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "export/surface_survey.h"
#include "patina/camera.h"

namespace patina {

/// Half a turn about x: a world with the first camera's axes (x right, y down, z forward) comes to glTF's y up.
inline constexpr glm::dquat kYDownToYUp{0, 1, 0, 0};

/// What says where up is.
enum class UpSource {
    kOption,   ///< the user
    kGravity,  ///< the recording
    kFloor,    ///< level and upright surface
    kCameras,  ///< how the cameras were held
    kNothing,  ///< y is taken for down
};
/// "option", "gravity", "floor", "cameras", "nothing".
const char* name_of(UpSource source);

/// What is known of up besides the surface, in the world.
struct UpHints {
    std::optional<glm::dvec3> up{};       ///< by the user; of any length but 0
    std::optional<glm::dvec3> gravity{};  ///< by the recording; of any length but 0
    std::vector<RigidTransform> cameras;  ///< poses, world_from_camera
};

/// How a world is placed in glTF's axes, y up, with its floor at height 0.
struct Upright {
    UpSource source = UpSource::kNothing;
    glm::dquat y_up_from_world = kYDownToYUp;  ///< unit length
    double floor_m = 0;                        ///< height of the floor after the rotation

    /// The direction up in the world.
    glm::dvec3 up() const { return glm::inverse(y_up_from_world) * glm::dvec3(0, 1, 0); }
    /// Of a point of the world.
    double height_of(glm::dvec3 point_m) const { return (y_up_from_world * point_m).y - floor_m; }
    RigidTransform gltf_from_world() const;
};

/// The mean of the cameras' up directions, brought across their x axes: cameras are tilted up and down rather than
/// rolled. Where they all face one way, only that one x axis says so, and the mean stays as it is along the rest. Empty
/// where there is no camera, or the directions cancel out.
std::optional<glm::dvec3> mean_up(std::span<const RigidTransform> cameras);

/// The rotation that brings `up` to y: from the nearest axis by a quarter or half turn, and from there by the shortest
/// way. A world whose axes are level keeps them level, and little changes of `up` change it little.
glm::dquat y_up_from(glm::dvec3 up);

/// Finds up. Without option and gravity it is the direction for which the most surface speaks: level surface, and a
/// quarter of what stands upright. It is one that some surface faces, at most 60 degrees from the cameras' mean up, and
/// with cameras that are rolled by at most 30 degrees; the more of both, the less the surface counts. Without 0.5 % of
/// the surface that are level, and 3 % that speak for it, up is the cameras' own.
///
/// The floor is the lowest level layer with a quarter of the area of the largest one, below the cameras where there are
/// any; without one the height above which 99 % of the surface are. Of nothing it is 0.
Upright find_upright(const UpHints& hints, std::span<const Patch> patches);

}  // namespace patina
