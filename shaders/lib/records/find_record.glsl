// Finds the record of a voxel, as interpolation between voxels needs it. The includer defines, before it includes this,
//   KEYS(bucket)    uvec4, the keys of a bucket of the observation map
//   BLOCK(slot)     uint, the block id of a table slot
//   RECORD(entry)   uint, an entry of the record table
#ifndef PATINA_LIB_FIND_RECORD_GLSL
#define PATINA_LIB_FIND_RECORD_GLSL
#include "lib/map/block_lookup.glsl"
#include "lib/records/observations.glsl"

// The record of the voxel at these coordinates, kNoRecord where it was never observed, or was refused one. World point
// p (metres) lies in voxel floor(p / grid.voxel_m), a block has 1 << edge_shift voxels along each edge.
uint find_record(VoxelGrid grid, uint edge_shift, ivec3 voxel) {
    const uint block = find_block(grid, voxel >> int(edge_shift));
    if (block == kNoBlock) return kNoRecord;
    const uint record = RECORD(block << 3u * edge_shift | voxel_number(voxel, edge_shift));
    return record < kNewRecord ? record : kNoRecord;
}

#endif
