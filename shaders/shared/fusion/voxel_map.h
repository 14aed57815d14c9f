// The sparse TSDF volume: a hash of blocks of 8^3 voxels. See passes/state/voxel_map.h.
#ifndef PATINA_SHARED_VOXEL_MAP_H
#define PATINA_SHARED_VOXEL_MAP_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kBlockEdge = 8u;          // voxels
INTEROP_CONST uint kBlockVoxels = 512u;      // x runs fastest, then y, then z
INTEROP_CONST uint kBucketSlots = 4u;        // keys of one bucket, loaded as a uvec4
INTEROP_CONST uint kMaxProbes = 16u;         // buckets looked at, from the key's own on
INTEROP_CONST uint kEmptyKey = 0xffffffffu;  // an unused slot, a free block
INTEROP_CONST uint kNoBlock = 0xffffffffu;   // a key without a block: the pool was full when it came
INTEROP_CONST uint kMaxVoxelChunks = 5u;     // buffers of distances, and of colours: with what else a pass binds, 16
INTEROP_CONST uint kGroupsPerRow = 512u;     // indirect dispatches over a list: group (x, y) takes item 512 y + x
INTEROP_CONST float kSdfRangeVox = 16.0f;    // a stored distance of 1 means this many voxels
INTEROP_CONST uint kWeightOne = 16u;         // what one frontal sample adds to a voxel's weight
INTEROP_CONST float kColorRange = 4.0f;      // the largest linear colour that a voxel can hold

// Where the grid lies. World point p (metres) lies in voxel floor(p / voxel_m); a voxel's value belongs to its centre.
struct VoxelGrid {
    ivec4 origin_block;  // xyz: the block in the middle of the range of keys; w unused
    float voxel_m;
    uint bucket_mask;  // buckets - 1, a power of two minus one
    uint capacity;     // blocks in the pool
    uint chunk_shift;  // block b lies in chunk b >> chunk_shift
};

// Counts that live on the GPU. The host reads them two frames late.
struct MapCounters {
    uint free_blocks;      // entries of the free list
    uint high_water;       // every block id in use is below this
    uint table_keys;       // keys in the table, refused ones included
    uint new_keys;         // keys inserted by the touch pass of this frame
    uint assign_keys;      // of these, what the assign pass goes through
    uint claim_base;       // free_blocks before this frame's assignment
    uint claimed;          // blocks popped so far in the assign pass
    uint accepted_bins;    // a new key gets a block when its hash lies in the first so many of kAcceptBins
    uint refused_blocks;   // over the whole run: keys that found the pool full
    uint refused_samples;  // over the whole run: ray samples that found the table full
    uint outside_samples;  // over the whole run: ray samples outside the range of keys
    uint deleted_blocks;   // over the whole run: blocks that held no surface
    uint capacity;         // places in the pool, as of this frame
    uint left_blocks;      // over the whole run: blocks that left the device
    uint returned_blocks;  // over the whole run: of them, blocks that came back and took a place
};

INTEROP_CONST uint kAcceptBins = 1024u;

INTEROP_END
#endif
