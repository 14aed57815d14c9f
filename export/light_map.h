#pragma once

#include "export/scene_parts.h"
#include "patina/image.h"

namespace patina {

/// The light that arrives at `from_m` as a picture of all directions: radiance, in linear pixel values. Rows go from
/// straight up to straight down. The middle looks along +x, the right half along +z (glTF's axes), as Blender and
/// three.js read an environment. A lamp is a disc as large as it looks from there, at least two pixels wide, whose
/// radiance adds up to what arrives of it. Every pixel has the ambient light. Nothing blocks a lamp.
Image<glm::vec3> light_map(const SceneParts& scene, glm::dvec3 from_m, Extent2D extent);

}  // namespace patina
