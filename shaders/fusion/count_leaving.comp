#version 460
#extension GL_GOOGLE_include_directive : require
// Counts the blocks outside the region by the bins of their hashes.
#include "lib/map/accepted_key.glsl"
#include "lib/map/stream_region.glsl"

layout(local_size_x = kLeaveGroup) in;
layout(std430, binding = 0) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 1) readonly buffer Counters { MapCounters counters; };
layout(std430, binding = 2) buffer Leaving { uint leaving[]; };
layout(push_constant) uniform Push { LeaveParams params; };

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= counters.high_water) return;
    const uint key = block_keys[block];
    if (key == kEmptyKey || stays(params.grid, params.region, key)) return;
    atomicAdd(leaving[kLeavingOutside], 1u);
    atomicAdd(leaving[kLeavingBins + accept_bin(hash_of_key(key))], 1u);
}
