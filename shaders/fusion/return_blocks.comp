#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per block that comes back: takes a place for it and enters its key in the table. A key that has a
// block keeps it, and the block's voxels are replaced.
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/stream_blocks.h"

layout(local_size_x = kLeaveGroup) in;
layout(std430, binding = 0) coherent buffer Keys { uint keys[]; };
layout(std430, binding = 1) buffer Blocks { uint blocks[]; };
layout(std430, binding = 2) buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 3) readonly buffer FreeList { uint free_list[]; };
layout(std430, binding = 4) buffer Counters { MapCounters counters; };
layout(std430, binding = 5) buffer Streamed { StreamedBlock streamed[]; };
layout(push_constant) uniform Push { ReturnParams params; };
#define RETURN_GRID params.grid
#include "fusion/return_main.glsl"

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item < params.count) return_block(item);
}
