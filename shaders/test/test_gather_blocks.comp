#version 460
#extension GL_GOOGLE_include_directive : require
// Copies the first blocks of the pool out of its chunks, one workgroup each.
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/test/test_voxel_map.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Tsdf { uint voxels[]; }
tsdf[kMaxVoxelChunks];
layout(std430, binding = 5) readonly buffer Color { uint voxels[]; }
color[kMaxVoxelChunks];
layout(std430, binding = 10) writeonly buffer GatheredTsdf { uint gathered_tsdf[]; };
layout(std430, binding = 11) writeonly buffer GatheredColor { uint gathered_color[]; };
layout(push_constant) uniform Push { TestMapParams params; };

void main() {
    const uint block = group_item(gl_WorkGroupID);
    if (block >= params.count) return;
    const uint from = index_in_chunk(params.grid.chunk_shift, block) * kBlockVoxels;
    const uint to = block * kBlockVoxels;
    for (uint i = gl_LocalInvocationIndex; i < kBlockVoxels; i += 64u) {
#define COPY(C)                                       \
    gathered_tsdf[to + i] = tsdf[C].voxels[from + i]; \
    gathered_color[to + i] = color[C].voxels[from + i]
        WITH_CHUNK(params.grid.chunk_shift, block, COPY)
    }
}
