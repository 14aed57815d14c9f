#pragma once

#include <vector>

#include "patina/texture.h"

namespace patina {

/// Distance on the surface over which the change at a seam fades.
inline constexpr double kSeamReach_m = 0.04;

/// Brings the sides of each seam, where charts of a layout meet, to the same albedo. They differ as each has texels of
/// its own, which pictures weigh and balance alone (add_finish_texels). At the seam all get their mean, of square
/// roots, in which what a picture showed counts far more than what was filled in. The change fades over kSeamReach_m.
/// Where two segments differ much, both stay: they are two paints. So do borders where the surface ends. `pages`: all
/// of the layout; states do not change.
void level_seams(const TextureLayout& layout, std::vector<TexturePage>& pages);

}  // namespace patina
