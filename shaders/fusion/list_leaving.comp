#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the blocks that leave, and gives back their places. Their voxels stay as they are until these are taken again,
// which passes do after those that copy them.
#include "lib/map/accepted_key.glsl"
#include "lib/map/stream_region.glsl"

layout(local_size_x = kLeaveGroup) in;
layout(std430, binding = 0) readonly buffer Leaving { uint leaving[]; };
layout(std430, binding = 1) buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 2) writeonly buffer FreeList { uint free_list[]; };
layout(std430, binding = 3) buffer Counters { MapCounters counters; };
layout(std430, binding = 4) buffer Streamed { StreamedBlock streamed[]; };
layout(std430, binding = 5) buffer StreamedCount { uvec4 streamed_count; };  // x
layout(push_constant) uniform Push { LeaveParams params; };

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= counters.high_water) return;
    const uint key = block_keys[block];
    if (key == kEmptyKey || stays(params.grid, params.region, key)) return;
    if (!is_accepted(hash_of_key(key), leaving[kLeavingAccepted])) return;
    streamed[atomicAdd(streamed_count.x, 1u)] = StreamedBlock(key, block, 0u, 0u, 0u, 0u);
    block_keys[block] = kEmptyKey;
    free_list[atomicAdd(counters.free_blocks, 1u)] = block;
    atomicAdd(counters.left_blocks, 1u);
}
