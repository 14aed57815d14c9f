#pragma once

#include "export/scene_parts.h"
#include "patina/image.h"

namespace patina {

/// Pictures of all directions: radiance, in linear pixel values. Rows go from straight up to straight down. The middle
/// looks along +x, the right half along +z (glTF's axes), as Blender and three.js read an environment.

/// Adds what arrives of a lamp at `from_m`, in the picture's axes: a disc as large as the lamp looks from there, at
/// least two pixels wide, whose radiance adds up to what arrives.
void add_to_map(const Light& light, glm::dvec3 from_m, Image<glm::vec3>& map);

/// The light that arrives at `from_m`: of each lamp, and from afar. The latter is the scene's environment; without one
/// every pixel has the ambient light. Nothing blocks a lamp.
Image<glm::vec3> light_map(const SceneParts& scene, glm::dvec3 from_m, Extent2D extent);

}  // namespace patina
