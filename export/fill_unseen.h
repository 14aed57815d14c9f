#pragma once

#include <cstdint>
#include <optional>

#include "patina/scene.h"

namespace patina {

/// A surface without vertices that nothing is known of, but for parts all of which are such.
struct FilledSurface {
    Mesh mesh;
    MeshReflectance reflectance;
    uint64_t vertices = 0;  ///< that got one
};

/// Depth reaches farther than colour: the camera of colours has a smaller view, and frames of low exposure have depth
/// alone. Vertices that no colour picture saw, and of which no albedo is known, get colour, albedo (of certainty 0.5)
/// and segment of the nearest ones along the surface, counted in edges; of several as near, the mean, and the segment
/// of the first. Parts of the surface without any colour stay as they are. Empty where there is nothing to fill.
std::optional<FilledSurface> filled_unseen(const Mesh& mesh, const MeshReflectance& reflectance);

}  // namespace patina
