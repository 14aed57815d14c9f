#pragma once

#include <glm/glm.hpp>

#include "scenes/description/shape.h"

namespace patina::scenes {

/// Throws Error naming the first triangle, by index, whose area is not finite or so small that it has no normal in
/// floats: a triangle is a sliver when its height is below 1e-7 of its longest edge, or its area below 1e-18 m^2. Also
/// throws when there is no triangle.
void check_triangles(const TriangleMesh& mesh);

/// The mesh turned by a rotation and scaled; normals stay of unit length.
TriangleMesh transformed(TriangleMesh mesh, const glm::dmat3& rotation, double scale);

/// The mesh scaled to a height along y, its lowest point (the largest y) at y = 0 and its bounding box centred in x and
/// z. Throws Error when it has no height.
TriangleMesh standing(TriangleMesh mesh, double height_m);

/// The mesh with normals averaged over the triangles around each position, weighted by their angle there. Vertices at
/// the same position share their normal, whatever their texture coordinates. Where the triangles cancel each other out,
/// a vertex has the normal of one of its own.
TriangleMesh with_smooth_normals(TriangleMesh mesh);

/// The same triangles with vertices that are equal in position, normal and texture coordinates joined, in the order of
/// their first use.
TriangleMesh joined(const TriangleMesh& mesh);

}  // namespace patina::scenes
