#version 460
#extension GL_GOOGLE_include_directive : require
// Copies the first blocks of the pool out of its chunks, one workgroup each.
#include "lib/voxel_chunks.glsl"
#include "lib/voxel_map.glsl"
#include "shared/test_voxel_map.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Tsdf { uint voxels[]; }
tsdf[kMaxTsdfChunks];
layout(std430, binding = 1) readonly buffer Color { uvec2 voxels[]; }
color[kMaxColorChunks];
layout(std430, binding = 2) writeonly buffer GatheredTsdf { uint gathered_tsdf[]; };
layout(std430, binding = 3) writeonly buffer GatheredColor { uvec2 gathered_color[]; };
layout(push_constant) uniform Push { TestMapParams params; };

void main() {
    const uint block = group_item(gl_WorkGroupID);
    if (block >= params.count) return;
    const uint from_tsdf = index_in_tsdf_chunk(params.grid, block) * kBlockVoxels;
    const uint from_color = index_in_color_chunk(params.grid, block) * kBlockVoxels;
    for (uint i = gl_LocalInvocationIndex; i < kBlockVoxels; i += 64u) {
#define COPY_TSDF(C) gathered_tsdf[block * kBlockVoxels + i] = tsdf[C].voxels[from_tsdf + i]
#define COPY_COLOR(C) gathered_color[block * kBlockVoxels + i] = color[C].voxels[from_color + i]
        WITH_TSDF_CHUNK(params.grid, block, COPY_TSDF)
        WITH_COLOR_CHUNK(params.grid, block, COPY_COLOR)
    }
}
