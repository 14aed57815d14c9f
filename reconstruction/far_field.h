#pragma once

#include <span>

#include <glm/glm.hpp>

#include "patina/image.h"
#include "shared/reflectance/far_field.h"
#include "shared/reflectance/surroundings.h"

namespace patina {

/// What pictures showed of a cell or a direction: rgb in linear pixel values, a 1; all 0 where too few pixels looked.
/// What low exposure shows counts where the usual one clips.
glm::vec4 mean_radiance(const gpu::SurroundingsLight& light);

/// What arrives from far away, as Scene::far_field has it: what openings such as windows showed, which frames of low
/// exposure show unclipped; else what pixels without any surface showed. Both by texel, gpu::kFarFieldTexels and
/// gpu::kOpeningTexels of them.
Image<glm::vec4> far_field_of(std::span<const gpu::FarFieldTexel> sky, std::span<const gpu::OpeningTexel> openings);

}  // namespace patina
