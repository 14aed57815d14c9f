// Look-up in the map's hash table. The includer says how to load it:
//   KEYS(bucket)    uvec4, the keys of a bucket
//   BLOCK(slot)     uint, the block id of a table slot
#ifndef PATINA_LIB_VOXEL_TABLE_GLSL
#define PATINA_LIB_VOXEL_TABLE_GLSL
#include "lib/voxel_map.glsl"

// The block of a key, kNoBlock where there is none.
uint block_of_table(VoxelGrid grid, uint key) {
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
    return slot == kNoBlock || key == kEmptyKey ? kNoBlock : BLOCK(slot);
}

#endif
