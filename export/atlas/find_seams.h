#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "patina/texture.h"

namespace patina {

/// An edge of a chart in its page.
struct SeamSide {
    uint32_t box = 0;  ///< of TextureLayout::boxes
    uint32_t page = 0;
    glm::vec2 from_px{0}, to_px{0};  ///< TexturedSurface::place_px
};

/// An edge of the surface at which charts meet: two sides or more, that begin at one end of it.
struct Seam {
    std::vector<SeamSide> sides;
};

/// All seams of a layout, of all its pieces. Edges meet where both ends have the same positions. The same layout gives
/// the same seams, in the same order.
std::vector<Seam> find_seams(const TextureLayout& layout);

}  // namespace patina
