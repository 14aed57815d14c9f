#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

#include "scenes/description/scene.h"

namespace patina::reference {

/// What is known of a point of a surface besides where it is.
struct Spot {
    glm::dvec3 geometric{0};  ///< the shape's own normal, unit length, either side
    glm::dvec3 normal{0};     ///< interpolated, unit length
    glm::dvec2 uv{0};
    glm::dvec3 smooth_m{0};  ///< the point moved onto the surface that a mesh's normals suggest, on `viewer`'s side
};

/// A rectangle; (u, v) are the coordinates along its half edges' directions.
struct Face {
    glm::dvec3 center_m, half_edge_u, half_edge_v;
};

/// A disc across a frame's y axis.
struct Disc {
    RigidTransform world_from_part;
    double y_m, radius_m;
};

/// The side of a cylinder around a frame's y axis.
struct Tube {
    RigidTransform world_from_part;
    double radius_m, half_height_m;
};

struct Ball {
    RigidTransform world_from_part;
    double radius_m;
};

struct Corner {
    glm::dvec3 position_m, normal;  ///< no normal: 0
    glm::dvec2 uv;
};

struct Triangle {
    std::array<Corner, 3> corners;
};

using Primitive = std::variant<Face, Disc, Tube, Ball, Triangle>;

/// The surfaces that bound a part, in the world.
std::vector<Primitive> surfaces_of(const scenes::Part& part);

/// The least distance above 0 at which a ray meets the surface from either side. `direction` has unit length.
std::optional<double> intersect(const Primitive& surface, glm::dvec3 origin_m, glm::dvec3 direction);

/// What is known of a point of the surface, seen from `viewer_m`.
Spot spot_at(const Primitive& surface, glm::dvec3 point_m, glm::dvec3 viewer_m);

}  // namespace patina::reference
