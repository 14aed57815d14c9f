#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/glm.hpp>

#include "patina/image.h"

// Pictures of all directions as Blender and three.js read an environment: rows from straight up (+y) to straight down,
// the middle along +x, the right half along +z.

namespace patina {

/// The unit direction of a place in a picture, in pixels from its top left corner.
glm::dvec3 direction_of_place(glm::dvec2 place_px, Extent2D extent);

/// The index of the pixel that holds a direction of unit length.
size_t pixel_of_direction(glm::dvec3 direction, Extent2D extent);

/// Of each pixel of a row, sr.
double solid_angle_of_row(uint32_t row, Extent2D extent);

/// Of linear colours, over all directions.
double mean_luminance(const Image<glm::vec3>& picture);

}  // namespace patina
