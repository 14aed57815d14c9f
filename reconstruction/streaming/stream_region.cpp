#include "reconstruction/streaming/stream_region.h"

#include <algorithm>
#include <cmath>

namespace patina {

namespace {

double block_m(const gpu::VoxelGrid& grid) { return double{grid.voxel_m} * gpu::kBlockEdge; }

bool all_up_to(glm::ivec3 a, glm::ivec3 b) { return glm::all(glm::lessThanEqual(a, b)); }

}  // namespace

StreamRegion StreamRegion::ball(glm::dvec3 center_m, double radius_m) {
    return {.center_m = center_m, .radius_m = radius_m};
}

StreamRegion StreamRegion::box(glm::ivec3 low, glm::ivec3 high) {
    StreamRegion region;
    region.low_block = low;
    region.high_block = high;
    return region;
}

StreamRegion StreamRegion::grown(double by_m) const {
    StreamRegion region = *this;
    region.radius_m += by_m;
    if (far_m > 0) {
        // Within the ball the cone does not matter.
        const double turned = std::asin(std::clamp(by_m / std::max(radius_m, by_m), -1.0, 1.0));
        region.half_angle = std::clamp(half_angle + turned, 0.0, kWidest);
        region.far_m += by_m;
    }
    return region;
}

bool StreamRegion::holds(const gpu::VoxelGrid& grid, glm::ivec3 block) const {
    if (!all_up_to(low_block, block) || !all_up_to(block, high_block)) return false;
    const glm::dvec3 offset_m = (glm::dvec3(block) + 0.5) * block_m(grid) - center_m;
    const double distance_m = glm::length(offset_m);
    return distance_m <= radius_m ||
           (distance_m <= far_m && glm::dot(offset_m, axis) >= std::cos(half_angle) * distance_m);
}

bool StreamRegion::meets(const gpu::VoxelGrid& grid, glm::ivec3 low, uint32_t edge) const {
    const glm::ivec3 high = low + static_cast<int>(edge) - 1;
    if (!all_up_to(low, high_block) || !all_up_to(low_block, high)) return false;
    const glm::dvec3 nearest =
        glm::clamp(center_m, glm::dvec3(low) * block_m(grid), glm::dvec3(high + 1) * block_m(grid));
    return glm::distance(nearest, center_m) <= std::max(radius_m, far_m);
}

glm::dvec3 StreamRegion::middle_m(const gpu::VoxelGrid& grid) const {
    if (radius_m < kUnbounded_m) return center_m;
    return (glm::dvec3(low_block) + glm::dvec3(high_block) + 1.0) / 2.0 * block_m(grid);
}

gpu::StreamRegion StreamRegion::gpu() const {
    const glm::vec4 cone(glm::vec3(axis * far_m), far_m > 0 ? static_cast<float>(std::cos(half_angle)) : 2.0f);
    return {glm::vec4(glm::vec3(center_m), static_cast<float>(radius_m)), cone, glm::ivec4(low_block, 0),
            glm::ivec4(high_block, 0)};
}

}  // namespace patina
