#include "tests/reference/fusion/allocate_blocks.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

namespace {

/// Whether the stretch from..to meets the box low..high: the overlap of its parameter's ranges, slab by slab.
bool meets(glm::dvec3 from, glm::dvec3 to, glm::dvec3 low, glm::dvec3 high) {
    double first = 0, last = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double span = to[axis] - from[axis];
        if (span == 0) {
            if (from[axis] < low[axis] || from[axis] >= high[axis]) return false;
            continue;
        }
        const double a = (low[axis] - from[axis]) / span, b = (high[axis] - from[axis]) / span;
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first < last;
}

void add_stretch(std::set<BlockCoordinates>& blocks, glm::dvec3 from, glm::dvec3 to, double block_m, double grow_m) {
    const glm::ivec3 low(glm::floor((glm::min(from, to) - std::max(grow_m, 0.0)) / block_m));
    const glm::ivec3 high(glm::floor((glm::max(from, to) + std::max(grow_m, 0.0)) / block_m));
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
            for (int x = low.x; x <= high.x; ++x) {
                const glm::dvec3 corner = glm::dvec3(x, y, z) * block_m;
                if (meets(from, to, corner - grow_m, corner + block_m + grow_m)) blocks.insert({x, y, z});
            }
        }
    }
}

}  // namespace

std::set<BlockCoordinates> touched_blocks(const Image<float>& depth_m, const Intrinsics& camera,
                                          const RigidTransform& world_from_camera, const Band& band, double grow_m,
                                          uint32_t stride, glm::uvec2 phase) {
    std::set<BlockCoordinates> blocks;
    for (uint32_t y = phase.y; y < camera.extent.height; y += stride) {
        for (uint32_t x = phase.x; x < camera.extent.width; x += stride) {
            const double depth = depth_m.at(x, y);
            if (!(depth > 0) || depth > band.max_depth_m) continue;
            const glm::dvec3 ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
            const double truncation = band.truncation_m + band.truncation_slope * depth;
            const auto at = [&](double z) { return glm::dvec3(world_from_camera * glm::dvec4(ray * z, 1)); };
            add_stretch(blocks, at(depth - truncation), at(depth + truncation), band.block_m, grow_m);
        }
    }
    return blocks;
}

}  // namespace patina::reference
