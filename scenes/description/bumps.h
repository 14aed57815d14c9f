#pragma once

#include <cstdint>

#include "scenes/description/shape.h"

namespace patina::scenes {

/// Bumps on a mesh, as scans of real things have them.
struct Bumps {
    double depth_m = 0;    ///< from the deepest to the highest, at most
    double size_m = 0.05;  ///< from one to the next, about; a third of the depth has half the size
    uint64_t seed = 0;
};

/// The mesh with each point moved along its smooth normal by noise, divided so finely that the bumps are round, with
/// smooth normals. Throws Error where that would take more than 4 million triangles.
TriangleMesh with_bumps(TriangleMesh mesh, const Bumps& bumps);

}  // namespace patina::scenes
