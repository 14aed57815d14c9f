#version 460
#extension GL_GOOGLE_include_directive : require
// Counts the records of blocks outside the region by the bins of their keys' hashes; a block without any counts as one.
#include "shared/observation/stream_records.h"

layout(local_size_x = kLeaveGroup) in;
layout(std430, binding = 0) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 1) readonly buffer Counters { MapCounters counters; };
layout(std430, binding = 2) readonly buffer RecordTable { uint record_table[]; };
layout(std430, binding = 3) buffer Leaving { uint leaving[]; };
layout(push_constant) uniform Push { LeaveRecordsParams params; };
#include "lib/records/leaving_records.glsl"

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= counters.high_water) return;
    const uint key = block_keys[block];
    if (!is_outside(key)) return;
    const uint places = max(records_of(block), 1u);
    atomicAdd(leaving[kLeavingOutside], places);
    atomicAdd(leaving[kLeavingBins + accept_bin(hash_of_key(key))], places);
}
