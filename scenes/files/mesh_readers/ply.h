#pragma once

#include <cstdint>
#include <span>

#include "scenes/description/shape.h"

namespace patina::scenes {

/// Reads a PLY file's faces: ASCII, binary of either byte order. Of its vertices x, y, z, the normals nx, ny, nz and
/// texture coordinates (u v, s t, texture_u texture_v, a picture's bottom left being (0, 0)) are taken, of its faces
/// vertex_indices and texcoord; everything else is passed over. Faces of fewer than three corners are left out. Throws
/// Error, without the file's name, on everything that the header and the rest contradict each other in.
TriangleMesh read_ply(std::span<const uint8_t> bytes);

}  // namespace patina::scenes
