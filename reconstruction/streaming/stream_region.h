#pragma once

#include <climits>

#include <glm/glm.hpp>

#include "shared/fusion/stream_blocks.h"

namespace patina {

/// A part of the map: the blocks whose coordinates lie in a box, and whose centres in a ball, or in a cone that begins
/// at the ball's centre.
struct StreamRegion {
    /// How many edges of a block what passes look at lies beside what they are about: two diagonals.
    static constexpr double kBlocksBeside = 4;

    static constexpr double kUnbounded_m = 1e9;
    glm::dvec3 center_m{0};
    double radius_m = kUnbounded_m;
    glm::dvec3 axis{0, 0, 1};               ///< of the cone, unit length
    double far_m = 0;                       ///< how far it reaches from its tip; 0: there is none
    double half_angle = 0;                  ///< of the cone, at most kWidest
    static constexpr double kWidest = 1.5;  ///< radians: a little less than a right angle
    glm::ivec3 low_block{INT_MIN / 2};      ///< lowest coordinates of the box
    glm::ivec3 high_block{INT_MAX / 2};     ///< highest ones

    /// A ball around a point of the world.
    static StreamRegion ball(glm::dvec3 center_m, double radius_m);
    /// Blocks by their coordinates, both corners included.
    static StreamRegion box(glm::ivec3 low, glm::ivec3 high);

    /// The region with everything that is as near to it as `by_m`; below 0, what is as deep in it. Where it is a box,
    /// the same one.
    StreamRegion grown(double by_m) const;

    bool holds(const gpu::VoxelGrid& grid, glm::ivec3 block) const;
    /// Whether it may hold a block of the cube of `edge` blocks that begins at `low`.
    bool meets(const gpu::VoxelGrid& grid, glm::ivec3 low, uint32_t edge) const;
    /// The middle of the ball, or of the box where it is one; metres.
    glm::dvec3 middle_m(const gpu::VoxelGrid& grid) const;
    gpu::StreamRegion gpu() const;
};

}  // namespace patina
