#pragma once

#include "patina/texture.h"

namespace patina {

/// The same surface with every triangle that has an edge longer than `longest_m` (above 0) cut into a grid whose steps
/// are no longer, for looking at what lies between the vertices: its triangles have edges of twice that at most, and
/// neighbours are cut differently. The vertices of `surface` come first, as they were. What vertices have is
/// interpolated; normals have unit length, but for those that cancel out; kd is not known where one of the three is
/// not. `filled` is empty.
TexturedSurface with_short_edges(const TexturedSurface& surface, double longest_m);

}  // namespace patina
