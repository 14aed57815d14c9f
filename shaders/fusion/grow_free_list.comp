#version 460
#extension GL_GOOGLE_include_directive : require
// Puts new places of a pool under those that were free before, which are popped first; and empties the count of the
// table's keys, which is filled anew.
#include "shared/fusion/voxel_map.h"
#include "shared/observation/grow_pool.h"

layout(local_size_x = kGrowGroup) in;
layout(std430, binding = 0) writeonly buffer FreeList { uint free_list[]; };
layout(std430, binding = 1) buffer Counters { MapCounters counters; };
layout(push_constant) uniform Push { GrowParams params; };

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= params.added) return;
    free_list[item] = params.before + params.added - 1u - item;
    if (item != 0u) return;
    counters.free_blocks += params.added;
    counters.capacity += params.added;
    counters.table_keys = 0u;
}
