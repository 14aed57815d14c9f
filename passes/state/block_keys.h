#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "shared/fusion/voxel_map.h"

namespace patina {

/// On the host what shaders/lib/map/voxel_map.glsl says of keys.

/// The coordinates of a block by its key, which is not kEmptyKey.
inline glm::ivec3 block_of_key(const gpu::VoxelGrid& grid, uint32_t key) {
    const glm::ivec3 biased(key & 0x7ff, key >> 11 & 0x3ff, key >> 21);
    return biased - glm::ivec3(1024, 512, 1024) + glm::ivec3(grid.origin_block);
}

inline uint32_t hash_of_key(uint32_t key) {
    key ^= key >> 16;
    key *= 0x7feb352du;
    key ^= key >> 15;
    key *= 0x846ca68bu;
    return key ^ key >> 16;
}

}  // namespace patina
