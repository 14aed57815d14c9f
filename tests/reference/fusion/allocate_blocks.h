#pragma once

#include <cstdint>
#include <set>

#include "patina/camera.h"
#include "tests/reference/fusion/volume.h"

namespace patina::reference {

struct Band {
    double block_m = 0;
    double truncation_m = 0;
    double truncation_slope = 0;
    double max_depth_m = 0;
};

/// The blocks that the truncation bands of a depth image meet: each reading's ray between depth - t and depth + t, t =
/// truncation_m + truncation_slope * depth. The blocks are taken as wider by `grow_m` on every side, which bounds the
/// answer of a less exact computation from both sides. Only pixels whose coordinates are `phase` modulo `stride` count.
std::set<BlockCoordinates> touched_blocks(const Image<float>& depth_m, const Intrinsics& camera,
                                          const RigidTransform& world_from_camera, const Band& band, double grow_m,
                                          uint32_t stride = 1, glm::uvec2 phase = {0, 0});

}  // namespace patina::reference
