#pragma once

#include <string>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "engine/core/camera.h"
#include "sensor/truth.h"

namespace patina::sensor {

/// A rectangle in the plane z = 0 of its object's frame, seen from both sides.
struct RectangleShape {
    glm::dvec2 half_size_m{0.5};
};

/// A box around the origin of its object's frame.
struct BoxShape {
    glm::dvec3 half_size_m{0.5};
};

/// A sphere around the origin of its object's frame.
struct SphereShape {
    double radius_m = 0.5;
};

/// A body of one Ward material. The material's id is also the object's: what label images show, in 1 .. 65535, unique
/// within the scene. Its kd must be given.
struct SceneObject {
    std::variant<RectangleShape, BoxShape, SphereShape> shape;
    RigidTransform world_from_object{1.0};
    Material material;
};

/// A camera that looks at a target from a fixed distance while azimuth and elevation oscillate:
/// azimuth(t) = amplitude sin(2 pi t / period), and elevation likewise around its mean.
struct OrbitPath {
    glm::dvec3 target_m{0};
    double distance_m = 4;
    double azimuth_amplitude_rad = 0;
    double azimuth_period_s = 1;
    double elevation_rad = 0;  ///< mean, above the horizon
    double elevation_amplitude_rad = 0;
    double elevation_period_s = 1;
};

/// A synthetic scene as plain data: everything in the world, and how it is recorded. World axes are those of an OpenCV
/// camera that stands upright: x right, y down, z forward, metres. So what is up has negative y, as in a recorded
/// sequence whose world is its first camera.
struct Scene {
    std::string name;
    std::vector<SceneObject> objects;
    std::vector<PointLight> lights;
    OrbitPath path;
    double fps = 30;
    Intrinsics camera{{512, 424}, 365.0, 365.0, 255.5, 211.5, {}};  ///< a Kinect v2's depth camera; no distortion
    double metres_per_unit = 0.001;                                 ///< of the depth pictures
    double max_metres = 8;
};

/// The camera's pose after `time_s`: at the path's distance from the target, which the optical axis passes through,
/// the image upright. The elevation must stay below 90 degrees.
RigidTransform world_from_camera(const OrbitPath& path, double time_s);

/// The pose of an object turned by `angle_rad` about `axis` (of any length), then moved to `position_m`.
RigidTransform placed(glm::dvec3 position_m, glm::dvec3 axis, double angle_rad);

/// What goes into truth/materials.json: every object's material, in the objects' order.
std::vector<Material> materials_of(const Scene& scene);

/// The built-in scene of that name. Throws Error listing the names when there is none.
Scene make_scene(const std::string& name);

}  // namespace patina::sensor
