#pragma once

#include <span>

#include <glm/glm.hpp>

#include "patina/image.h"
#include "shared/reflectance/far_field.h"
#include "shared/reflectance/surroundings.h"

namespace patina {

/// What arrives from far away, as Scene::far_field has it: what openings such as windows showed, which frames of low
/// exposure show unclipped; else what pixels without any surface showed. Both by texel, gpu::kFarFieldTexels and
/// gpu::kOpeningTexels of them.
Image<glm::vec4> far_field_of(std::span<const gpu::FarFieldTexel> sky, std::span<const gpu::OpeningTexel> openings);

}  // namespace patina
