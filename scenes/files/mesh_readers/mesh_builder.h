#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <glm/glm.hpp>

#include "scenes/description/shape.h"

namespace patina::scenes {

/// The most corners of a face that readers believe. A corner of one byte in a file takes 80 in memory.
inline constexpr size_t kMostFaceCorners = size_t{1} << 20;

/// A corner of a face, as its file has it.
struct MeshCorner {
    glm::dvec3 position{0};
    std::optional<glm::dvec3> normal{};  ///< of any length
    std::optional<glm::dvec2> uv{};      ///< (0, 0) is a picture's top left
};

/// Gathers a file's faces as triangles, no two of which share a vertex.
class MeshBuilder {
  public:
    /// Splits a face of three or more corners, convex or not, into triangles. Throws Error when a position or texture
    /// coordinate is not finite, a face that is not convex has too many corners to be split, or the mesh gets more than
    /// limits::kTriangles.
    void add_face(std::span<const MeshCorner> corners);

    /// The mesh. It has normals or texture coordinates where any corner has: another corner's normal is then its
    /// triangle's, as where a normal has no length, and its texture coordinates are (0, 0).
    TriangleMesh finish() &&;

  private:
    void add_corner(const MeshCorner& corner);

    TriangleMesh mesh_;
    bool has_normals_ = false;
    bool has_uvs_ = false;
};

}  // namespace patina::scenes
