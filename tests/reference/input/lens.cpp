#include "tests/reference/input/lens.h"

namespace patina::reference {

std::optional<glm::dvec2> find_source(const Intrinsics& camera, uint32_t x, uint32_t y) {
    const glm::dvec2 source = project(camera, {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1});
    const bool inside = source.x >= -0.5 && source.y >= -0.5 && source.x < camera.extent.width - 0.5 &&
                        source.y < camera.extent.height - 0.5;
    return inside ? std::optional(source) : std::nullopt;
}

}  // namespace patina::reference
