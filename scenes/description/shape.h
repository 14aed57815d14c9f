#pragma once

#include <memory>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

namespace patina::scenes {

/// A rectangle in the plane z = 0 of its part's frame, seen from both sides.
struct RectangleShape {
    glm::dvec2 half_size_m{0.5};
};

/// A box around the origin of its part's frame.
struct BoxShape {
    glm::dvec3 half_size_m{0.5};
};

/// A sphere around the origin of its part's frame.
struct SphereShape {
    double radius_m = 0.5;
};

/// A cylinder around the y axis of its part's frame, closed by discs at y = -half_height_m and y = half_height_m.
struct CylinderShape {
    double radius_m = 0.5;
    double half_height_m = 0.5;
};

/// Triangles in an part's frame, metres; both sides are seen.
struct TriangleMesh {
    std::vector<glm::vec3> positions_m;
    std::vector<glm::vec3> normals;              ///< one per position, unit length; empty: each triangle's own
    std::vector<glm::vec2> texture_coordinates;  ///< one per position; empty: none
    std::vector<glm::uvec3> triangles;
};

struct MeshShape {
    std::shared_ptr<const TriangleMesh> mesh;
};

using Shape = std::variant<RectangleShape, BoxShape, SphereShape, CylinderShape, MeshShape>;

}  // namespace patina::scenes
