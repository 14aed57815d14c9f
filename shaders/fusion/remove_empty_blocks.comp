#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per visible block: gives the block back unless one of its voxels has been seen near the surface.
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/allocate_blocks.h"
#include "shared/fusion/remove_empty_blocks.h"

layout(local_size_x = kRemoveGroup) in;
layout(std430, binding = 0) readonly buffer Visible { uint visible[]; };
layout(std140, binding = 1) uniform Fusion { FusionParams fusion; };
layout(std430, binding = 2) readonly buffer Tsdf { uvec4 quads[]; }
tsdf[kMaxVoxelChunks];
layout(std430, binding = 3) buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 4) writeonly buffer FreeList { uint free_list[]; };
layout(std430, binding = 5) buffer Counters { MapCounters counters; };

shared uint holds_surface;

void main() {
    const uint item = group_item(gl_WorkGroupID);
    if (item >= visible[0]) return;
    const uint block = visible[1u + item];
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) holds_surface = 0u;
    barrier();

    const uint quad = index_in_chunk(fusion.grid.chunk_shift, block) * (kBlockVoxels / 4u) + lane;
#define LOAD_TSDF(C) voxels = tsdf[C].quads[quad]
    uvec4 voxels;
    WITH_CHUNK(fusion.grid.chunk_shift, block, LOAD_TSDF)
    const float limit = kSurfaceTruncation * fusion.truncation_m / (kSdfRangeVox * fusion.grid.voxel_m);
    bool near = false;
    for (int i = 0; i < 4; ++i) near = near || (voxel_weight(voxels[i]) > 0u && abs(voxel_sdf(voxels[i])) < limit);
    if (near) atomicOr(holds_surface, 1u);
    barrier();

    // A list that is some passes old may name blocks that are free by now.
    if (lane != 0u || holds_surface != 0u || block_keys[block] == kEmptyKey) return;
    block_keys[block] = kEmptyKey;
    free_list[atomicAdd(counters.free_blocks, 1u)] = block;
    atomicAdd(counters.deleted_blocks, 1u);
}
