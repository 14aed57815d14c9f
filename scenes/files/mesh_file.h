#pragma once

#include <compare>
#include <filesystem>
#include <optional>

#include "scenes/description/shape.h"

namespace patina::scenes {

enum class MeshUp { kY, kZ, kMinusY };             ///< the direction in the file that becomes up, -y
enum class MeshNormals { kFile, kSmooth, kFlat };  ///< the file's, or flat if it has none; computed; each triangle's

/// How a mesh file becomes a mesh of a scene.
struct MeshSettings {
    MeshUp up = MeshUp::kY;
    MeshNormals normals = MeshNormals::kFile;
    std::optional<double> height_m{};  ///< scaled to it, standing on its origin
    double scale = 1;                  ///< metres per unit of the file; unused with a height

    auto operator<=>(const MeshSettings&) const = default;
};

/// Reads all triangles of an OBJ, PLY, GLB or glTF file with their nodes' transforms as one mesh; polygons are split,
/// points and lines left out, equal vertices joined. A glTF or OBJ picture's top left is texture coordinate (0, 0).
/// Materials, colours, skins and animations of the file are ignored. Throws Error naming the file when it is missing,
/// damaged, of another kind, too large (see limits), without triangles, or has a degenerate triangle (see
/// check_triangles).
TriangleMesh read_mesh(const std::filesystem::path& file, const MeshSettings& settings);

}  // namespace patina::scenes
