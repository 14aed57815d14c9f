#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "patina/scene.h"

namespace patina {

/// A mesh with fewer triangles, and how far it is from the one it was made from.
struct CoarserMesh {
    Mesh mesh;
    std::vector<uint32_t> vertices;  ///< of the finer mesh, by vertex
    double error_m = 0;
};

/// Collapses edges, down to some part of the triangles at best (meshoptimizer). Vertices are some of those there were;
/// those at open borders stay, so that meshes which meet there still do. `shades`, by vertex, 0 to 1, are kept as shape
/// is: what they miss counts as kShade_m of height, in error_m too.
inline constexpr float kShade_m = 0.1f;
CoarserMesh coarser(const Mesh& mesh, std::span<const float> shades, double part);

}  // namespace patina
