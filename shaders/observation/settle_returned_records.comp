#version 460
#extension GL_GOOGLE_include_directive : require
// After records came back: counts the places that they took, gives back those of records that did not need theirs, and
// sets the dispatch over all block ids in use.
#include "shared/fusion/allocate_blocks.h"
#include "shared/observation/stream_records.h"

layout(local_size_x = 1) in;
layout(std430, binding = 0) readonly buffer Streamed { StreamedBlock streamed[]; };
layout(std430, binding = 1) readonly buffer Returned { ReturnedCount returned; };
layout(std430, binding = 2) readonly buffer BlockCounters { MapCounters blocks; };
layout(std430, binding = 3) buffer RecordCounters { MapCounters counted; };
layout(std430, binding = 4) buffer FreeRecords { uint free_records[]; };
layout(std430, binding = 5) writeonly buffer BlockArguments { uvec4 block_arguments; };
layout(push_constant) uniform Push { ReturnRecordsParams params; };

// The places of a list's records lie in its reverse order in the stack; from its end on they move down, each to a place
// that was read before.
uint give_back_unused(uint top, uint free) {
    for (uint i = params.block_count; i > 0u; --i) {
        const StreamedBlock block = streamed[i - 1u];
        const uint end = block.first_record + block.records;
        if (end > returned.claimed || (block.block != kNoBlock && block.fresh != 0u)) continue;
        for (uint record = end; record > block.first_record; --record)
            free_records[free++] = free_records[top - record];
    }
    return free;
}

void main() {
    const uint top = counted.free_blocks;
    uint free = top - returned.claimed;
    counted.high_water = max(counted.high_water, params.record_capacity - free);
    if (returned.unused > 0u) free = give_back_unused(top, free);
    counted.free_blocks = free;
    counted.returned_blocks += returned.claimed - returned.unused;
    block_arguments = uvec4((blocks.high_water + kAssignGroup - 1u) / kAssignGroup, 1u, 1u, 0u);
}
