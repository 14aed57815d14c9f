#pragma once

#include <span>
#include <vector>

#include "patina/lighting.h"
#include "shared/reflectance/surroundings.h"

namespace patina {

/// The windows among the cells of the surroundings (passes/reflectance/collect_surroundings.h): openings that are at
/// least as bright as surfaces are on average, touch each other, and fill a rectangle of 0.02 m^2 or more in a plane.
/// Each shines to the side of the surfaces' middle. Its radiance is the mean over its cells. The largest come first.
/// Cells 51 m apart are one.
std::vector<AreaLight> find_windows(std::span<const gpu::SurroundingsCell> cells);

}  // namespace patina
