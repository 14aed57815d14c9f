#pragma once

#include <filesystem>

#include "sensor/synthetic/shape.h"

namespace patina::figure {

/// Writes a mesh with normals as binary little-endian PLY. Throws Error when the file cannot be written.
void write_ply(const std::filesystem::path& file, const sensor::TriangleMesh& mesh);

}  // namespace patina::figure
