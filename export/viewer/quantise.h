#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "export/scene_parts.h"

namespace patina {

/// A vertex as the HTML viewer gets it: 16 bytes.
struct ViewerVertex {
    std::array<uint16_t, 3> position{};  ///< 0 to 65535 between the corners of the scene's box
    uint16_t material = 0;               ///< of SceneParts::materials
    std::array<int16_t, 2> normal{};     ///< octahedral, -32767 to 32767
    /// Where it lies in a page, 0 to 65535; without a page red and green, and blue, as sRGB codes.
    std::array<uint16_t, 2> look{};
};
static_assert(sizeof(ViewerVertex) == 16);

/// What is drawn at once: all parts of one page, or those of none.
struct ViewerGroup {
    uint32_t page = ScenePart::kNoPage;
    std::vector<ViewerVertex> vertices;
    std::vector<std::array<uint32_t, 3>> triangles;
};

/// A scene's surface, quantised. Positions are off by at most half a step, which is the box's edge / 65535; normals by
/// at most 0.01 degrees. Throws Error for more than 65 536 materials.
std::vector<ViewerGroup> quantised(const SceneParts& scene);

}  // namespace patina
