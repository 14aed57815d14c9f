#version 460
#extension GL_GOOGLE_include_directive : require
// Voxels that were refused a record may ask again. One invocation per block.
#include "shared/fusion/allocate_blocks.h"
#include "shared/observation/grow_pool.h"
#include "shared/observation/observations.h"

layout(local_size_x = kAssignGroup) in;
layout(std430, binding = 0) readonly buffer Counters { MapCounters counters; };
layout(std430, binding = 1) buffer RecordTable { uint record_table[]; };
layout(push_constant) uniform Push { RetryParams params; };

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= counters.high_water) return;
    for (uint i = 0u; i < params.block_voxels; ++i) {
        const uint entry = block * params.block_voxels + i;
        if (record_table[entry] == kRefusedRecord) record_table[entry] = kNoRecord;
    }
}
