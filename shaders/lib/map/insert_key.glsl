// Inserts keys into the map's table. The includer declares, before it includes this,
//   layout(std430, binding = n) coherent buffer Keys { uint keys[]; };
#ifndef PATINA_LIB_INSERT_KEY_GLSL
#define PATINA_LIB_INSERT_KEY_GLSL
#include "lib/map/voxel_map.glsl"

const uint kNoSlot = 0xffffffffu;

struct Insertion {
    uint slot;   // where the key is; kNoSlot where it is not, for lack of room or of `may_insert`
    bool fresh;  // this call put it there
};

// Finds a key, or inserts it at the first free slot from its own bucket on. Any number of invocations may insert at
// once.
Insertion insert_key(VoxelGrid grid, uint key, bool may_insert) {
    uint bucket = hash_of_key(key) & grid.bucket_mask;
    for (uint probe = 0u; probe < kMaxProbes; ++probe) {
        const uint first = bucket * kBucketSlots;
        const uvec4 found = uvec4(keys[first], keys[first + 1u], keys[first + 2u], keys[first + 3u]);
        const bvec4 same = equal(found, uvec4(key));
        if (any(same)) return Insertion(first + (same.x ? 0u : same.y ? 1u : same.z ? 2u : 3u), false);
        // A key never leaves its slot in this pass, so a taken slot is final. A free one may be so no longer, whichever
        // of the four it is (the loads are four): the exchange decides.
        if (any(equal(found, uvec4(kEmptyKey)))) {
            if (!may_insert) break;
            for (uint i = 0u; i < kBucketSlots; ++i) {
                const uint before = atomicCompSwap(keys[first + i], kEmptyKey, key);
                if (before == key || before == kEmptyKey) return Insertion(first + i, before == kEmptyKey);
            }
        }
        bucket = (bucket + 1u) & grid.bucket_mask;
    }
    return Insertion(kNoSlot, false);
}

#endif
