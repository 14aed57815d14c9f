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

/// Where collapsing ends.
struct Coarseness {
    double part = 0;           ///< of the triangles that there were; fewer are not asked for
    double error_m = 1e9;      ///< distance from the finer mesh, about
    float white_m = 0.1f;      ///< what a step of the shade from 0 to 1 counts as height
    bool locks_border = true;  ///< vertices at open borders stay, so that meshes which meet there still do
};

/// How bright a mesh's vertices look under light of one brightness: by their albedo, where it is known.
std::vector<float> shades_of(const Mesh& mesh, const MeshReflectance& reflectance);

/// Collapses edges until one of the limits is met, or nothing can go (meshoptimizer). Vertices are some of those there
/// were. Vertices of one position are one to it, where two surfaces meet along a line. `shades`, by vertex, 0 to 1, are
/// kept as shape is: what they miss counts as height, in error_m too.
CoarserMesh coarser(const Mesh& mesh, std::span<const float> shades, const Coarseness& coarseness);

}  // namespace patina
