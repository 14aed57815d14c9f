#pragma once

#include <filesystem>

#include "export/scene_parts.h"

namespace patina {

/// What a PLY file holds besides vertices.
enum class PlyContent {
    kMesh,   ///< triangles
    kPoints  ///< nothing
};

/// Writes a scene's surface as binary little-endian PLY, in glTF's axes. A vertex has x, y, z (metres), nx, ny, nz,
/// red, green, blue (sRGB of the diffuse albedo; of the recorded colour where no reflectance is known), label (0: none)
/// and, where the scene has reflectance, kd_red, kd_green, kd_blue, ks_red, ks_green, ks_blue and alpha. ks and alpha
/// are those of the segment, NaN where they were not observed. Throws Error for more vertices than 32 bits count, or a
/// disk that refuses.
void write_ply(const std::filesystem::path& path, const SceneParts& scene, PlyContent content);

}  // namespace patina
