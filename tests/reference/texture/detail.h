#pragma once

#include <glm/glm.hpp>

#include "tests/reference/fusion/volume.h"
#include "tests/reference/texture/bake.h"

namespace patina::reference {

/// What add_detail_normals finds at a texel's point: the volume's normal in the frame of the mesh's. `tangent`: as glTF
/// has it. (0, 0, 1) where nothing is known, or the two are more than 60 degrees apart.
glm::dvec3 detail_normal(const Volume& volume, const PlacedTexel& texel, glm::dvec4 tangent);

}  // namespace patina::reference
