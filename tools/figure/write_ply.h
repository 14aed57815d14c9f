#pragma once

#include <filesystem>

#include "scenes/description/shape.h"

namespace patina::figure {

/// Writes a mesh with normals as binary little-endian PLY. Throws Error when the file cannot be written.
void write_ply(const std::filesystem::path& file, const scenes::TriangleMesh& mesh);

}  // namespace patina::figure
