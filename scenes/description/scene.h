#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "patina/camera.h"
#include "patina/image.h"
#include "scenes/description/path.h"
#include "scenes/description/recording.h"
#include "scenes/description/shape.h"
#include "sensor/truth.h"

namespace patina::scenes {

/// kd that varies over a surface. Pictures repeat in both directions and are interpolated bilinearly. The coordinates
/// (u, v) run along the surface: in metres on a rectangle (x, y), on each face of a box (its two axes in the order of
/// their names), around and along a cylinder (its discs: x, z) and, as longitude and latitude times radius, on a
/// sphere; a mesh has its own texture coordinates. Longitude 0 is in the direction +z and grows towards +x, latitude
/// grows with y. At (0, 0) is the picture's top left corner; u runs along its rows, v down its columns.
struct Texture {
    std::shared_ptr<const Image<glm::vec3>> kd;  ///< linear albedo
    glm::dvec2 repeat{1};                        ///< what one repeat of the picture spans in (u, v)
};

/// A shape and where it is.
struct Part {
    Shape shape;
    RigidTransform world_from_part{1.0};
};

/// A thing of one Ward material, made of one or more parts. The material's id is also the object's: what label images
/// show, in 1 .. 65535, unique within the scene. Either its kd is given, or a texture.
struct SceneObject {
    std::vector<Part> parts;
    sensor::Material material;
    std::optional<Texture> texture{};
};

/// Light from afar, a latitude-longitude picture of radiance: its centre column lies in the direction +z, its top row
/// straight up (-y); columns to the right turn towards +x.
struct Environment {
    std::shared_ptr<const Image<glm::vec3>> radiance;  ///< linear pixel values
};

/// How the lighting sequence (paper, Section 3.2) is recorded.
struct LightingRecording {
    CameraPath path;
    uint32_t frames = 60;
};

/// A synthetic scene as plain data: everything in the world, and how it is recorded. World axes are those of an OpenCV
/// camera that stands upright: x right, y down, z forward, metres. So what is up has negative y, as in a recorded
/// sequence whose world is its first camera.
struct SyntheticScene {
    std::string name;
    std::vector<SceneObject> objects;
    /// Lamps. One whose radius is above 0 is a sphere with the radiance intensity / (pi radius^2), if it is flat
    /// times the cosine of the direction to its axis: cameras see it, it has depth, no reflectance and label 0, and
    /// casts no shadow.
    std::vector<Light> lights;
    std::optional<Environment> environment;
    CameraPath path;
    std::optional<LightingRecording> lighting;
    double fps = 30;
    Intrinsics camera{{512, 424}, 365.0, 365.0, 255.5, 211.5, {}};  ///< a Kinect v2's depth camera; no distortion
    std::optional<ColorCamera> color_camera;                        ///< empty: colour is registered to depth
    double metres_per_unit = 0.001;                                 ///< of the depth pictures
    double max_metres = 8;
    Recording recording;
};

/// What goes into truth/materials.json: every object's material, in the objects' order.
std::vector<sensor::Material> materials_of(const SyntheticScene& scene);

/// The radiance of a sphere-shaped lamp, of a flat one along its axis; 0 for a point.
glm::dvec3 emitted_radiance(const Light& light);

}  // namespace patina::scenes
