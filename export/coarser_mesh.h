#pragma once

#include <cstdint>
#include <vector>

#include "patina/scene.h"

namespace patina {

/// A mesh with fewer triangles, and how far it lies from the one it was made from.
struct CoarserMesh {
    Mesh mesh;
    std::vector<uint32_t> vertices;  ///< of the finer mesh, by vertex
    double error_m = 0;
};

/// Collapses edges, down to some part of the triangles at best (meshoptimizer). Vertices are some of those there were;
/// those at open borders stay, so that meshes which meet there still do.
CoarserMesh coarser(const Mesh& mesh, double part);

}  // namespace patina
