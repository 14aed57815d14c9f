#pragma once

#include <span>
#include <vector>

#include "patina/lighting.h"
#include "shared/reflectance/surroundings.h"

namespace patina {

/// The windows among the cells of the surroundings (passes/reflectance/collect_surroundings.h): openings that are at
/// least as bright as surfaces are on average, clipped or shown by low exposure, away from lamps, touch each other, and
/// fill a rectangle in a plane. It is 0.1 m wide at least and has 0.02 m^2. A surface of that kind that gave no depth
/// passes for one, too. Each shines to the side of the surfaces within 2 m, or of `inside_m` where these lie in its
/// plane. Its radiance is the mean over its cells. The largest come first, 64 at most. Of places 51 m apart, which
/// cells do not tell apart, it is the one nearest to `inside_m`: where cameras were. `lamps` may hold suns.
std::vector<AreaLight> find_windows(std::span<const gpu::SurroundingsCell> cells, glm::dvec3 inside_m,
                                    std::span<const Light> lamps = {});

}  // namespace patina
