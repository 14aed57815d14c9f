#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "scenes/description/shape.h"

namespace patina::scenes {

/// Reads the triangles of a glTF 2.0 file, as GLB or as JSON: of the default scene's nodes, each with its place. A
/// buffer outside is read where it lies in the file's own folder, or below. Materials, pictures, skins, morph targets
/// and animations are passed over. Throws Error, without the file's name, on what is damaged, contradicts itself, is a
/// sparse accessor or is compressed.
TriangleMesh read_gltf(const std::filesystem::path& file, std::span<const uint8_t> bytes);

}  // namespace patina::scenes
