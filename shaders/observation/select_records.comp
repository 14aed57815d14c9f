#version 460
#extension GL_GOOGLE_include_directive : require
// Decides which of the voxels seen for the first time get a record.
#include "lib/records/record_hash.glsl"
#include "shared/fusion/allocate_blocks.h"
#include "shared/observation/observations.h"

layout(std430, binding = 0) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 1) readonly buffer NewVoxels { uint new_voxels[]; };
layout(std430, binding = 2) buffer Counters { MapCounters counters; };
layout(std430, binding = 3) writeonly buffer AssignArguments { uvec4 assign_arguments; };
layout(std140, binding = 4) uniform Observation { ObservationParams frame; };

uint hash_of_entry(uint entry) {
    const uint shift = 3u * frame.edge_shift;
    return hash_of_voxel(block_keys[entry >> shift], entry & ((1u << shift) - 1u));
}
#define HASH(i) hash_of_entry(new_voxels[i])
#include "fusion/select_main.glsl"

void main() {
    const uint total = select_keys(frame.record_capacity);
    if (gl_LocalInvocationIndex != 0u) return;
    assign_arguments = uvec4((total + kRecordGroup - 1u) / kRecordGroup, 1u, 1u, 0u);
}
