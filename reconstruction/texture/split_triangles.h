#pragma once

#include "patina/texture.h"

namespace patina {

/// The same surface with every triangle that has an edge longer than `longest_m` (above 0) split into equal parts, so
/// that none has. What vertices have is interpolated; normals have unit length, but for those that cancel out. What the
/// new vertices reflect is that of the triangle's first one.
TexturedSurface with_short_edges(const TexturedSurface& surface, double longest_m);

}  // namespace patina
