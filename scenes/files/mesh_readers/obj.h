#pragma once

#include <cstdint>
#include <span>

#include "scenes/description/shape.h"

namespace patina::scenes {

/// Reads the faces of a Wavefront OBJ file: v, vn, vt and f, with indices that count from the first element or, below
/// 0, back from the latest; everything else, as groups, materials, lines and points, is passed over. Throws Error, with
/// the line but without the file's name, on an index without an element and on what is no number.
TriangleMesh read_obj(std::span<const uint8_t> bytes);

}  // namespace patina::scenes
