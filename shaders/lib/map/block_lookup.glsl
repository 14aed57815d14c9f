// Finds blocks in the map's table. The includer defines, before it includes this,
//   KEYS(bucket)    uvec4, the keys of a bucket
//   BLOCK(slot)     uint, the block id of a table slot
#ifndef PATINA_LIB_BLOCK_LOOKUP_GLSL
#define PATINA_LIB_BLOCK_LOOKUP_GLSL
#include "lib/map/voxel_map.glsl"

uint cached_key = kEmptyKey;
uint cached_block = kNoBlock;

// The block at block coordinates, kNoBlock where there is none. Remembers the last answer: most look-ups stay in one
// block.
uint find_block(VoxelGrid grid, ivec3 coordinates) {
    const uint key = key_of_block(grid, coordinates);
    if (key != cached_key) {
        uint slot = kNoBlock;
        uint bucket = hash_of_key(key) & grid.bucket_mask;
        for (uint probe = 0u; probe < kMaxProbes; ++probe) {
            const uvec4 keys = KEYS(bucket);
            const bvec4 same = equal(keys, uvec4(key));
            const uint first = bucket * kBucketSlots;
            slot = same.x ? first : same.y ? first + 1u : same.z ? first + 2u : same.w ? first + 3u : slot;
            if (slot != kNoBlock || keys.w == kEmptyKey) break;
            bucket = (bucket + 1u) & grid.bucket_mask;
        }
        cached_key = key;
        cached_block = slot == kNoBlock || key == kEmptyKey ? kNoBlock : BLOCK(slot);
    }
    return cached_block;
}

#endif
