#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per listed block: copies its words out of one of the map's arrays.
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/stream_blocks.h"

layout(local_size_x = kCopyGroup) in;
layout(std430, binding = 0) readonly buffer Streamed { StreamedBlock streamed[]; };
layout(std430, binding = 1) readonly buffer StreamedCount { uvec4 streamed_count; };  // x
layout(std430, binding = 2) readonly buffer Words { uvec4 quads[]; }
words[kMaxVoxelChunks];
layout(std430, binding = 7) writeonly buffer Packed { uvec4 packed_quads[]; };
layout(push_constant) uniform Push { StreamParams params; };

void main() {
    const uint item = group_item(gl_WorkGroupID);
    if (item >= min(streamed_count.x, params.count)) return;
    const uint block = streamed[item].block;
    if (block == kNoBlock) return;
    const uint first = index_in_chunk(params.chunk_shift, block) * (kBlockVoxels / 4u);
#define PACK(C)                                                                      \
    for (uint i = gl_LocalInvocationIndex; i < kBlockVoxels / 4u; i += kCopyGroup) { \
        packed_quads[item * (kBlockVoxels / 4u) + i] = words[C].quads[first + i];    \
    }
    WITH_CHUNK(params.chunk_shift, block, PACK)
}
