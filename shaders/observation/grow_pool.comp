#version 460
#extension GL_GOOGLE_include_directive : require
// Counts the new places of a pool of observations, whose ids follow from the count; and empties the count of the
// table's keys, which is filled anew (records have no table).
#include "shared/fusion/voxel_map.h"
#include "shared/observation/grow_pool.h"

layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Counters { MapCounters counters; };
layout(push_constant) uniform Push { GrowParams params; };

void main() {
    counters.free_blocks += params.added;
    counters.capacity += params.added;
    counters.table_keys = 0u;
}
