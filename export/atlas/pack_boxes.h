#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina {

/// Where boxes lie in square pages.
struct PackedBoxes {
    struct Place {
        uint32_t page = 0;
        glm::uvec2 at{0};  ///< of the box's low corner, texels
    };
    std::vector<Place> places;    ///< by box
    std::vector<Extent2D> pages;  ///< only as high as is used
};

/// Packs boxes (texels, no side above `page`) into as few pages as it finds, none wider or higher than `page`; a single
/// page is no wider than it must be. The same boxes give the same places.
PackedBoxes pack_boxes(std::span<const glm::uvec2> boxes, uint32_t page);

}  // namespace patina
