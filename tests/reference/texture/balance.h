#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::reference {

/// A page before it is balanced, by texel.
struct SeenPage {
    Extent2D extent;
    double texel_m = 0;
    std::vector<std::optional<glm::dvec3>> position_m;  ///< empty: no surface
    std::vector<glm::dvec3> known;                      ///< by records
    std::vector<std::optional<glm::dvec3>> seen;        ///< mean by pictures; empty: none shows it
};

/// The albedo of each texel with surface: what the passes of passes/texture/balance_texels.h and finish_texels.h make.
std::vector<glm::dvec3> balance_page(const SeenPage& page);

}  // namespace patina::reference
