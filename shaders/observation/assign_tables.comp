#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per new key: takes the next block and empties its voxels' entries of the record table; or leaves the
// key without a block when it was not among those accepted.
#include "lib/map/accepted_key.glsl"
#include "lib/map/voxel_map.glsl"
#include "lib/records/observations.glsl"

layout(local_size_x = kTableGroup) in;
layout(std430, binding = 0) readonly buffer Keys { uint keys[]; };
layout(std430, binding = 1) readonly buffer NewSlots { uint new_slots[]; };
layout(std430, binding = 2) buffer Counters { MapCounters counters; };
layout(std430, binding = 3) buffer Blocks { uint blocks[]; };
layout(std430, binding = 4) buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 5) buffer RecordTable { uvec4 record_table[]; };
layout(std140, binding = 6) uniform Observation { ObservationParams frame; };
layout(std430, binding = 7) readonly buffer FreeBlocks { uint free_blocks[]; };

shared uint block;

void claim(uint slot) {
    const uint key = keys[slot];
    block = kNoBlock;
    if (is_accepted(hash_of_key(key), counters.accepted_bins)) {
        block = free_blocks[counters.claim_base - 1u - atomicAdd(counters.claimed, 1u)];
        block_keys[block] = key;
    }
    blocks[slot] = block;
}

void main() {
    const uint item = group_item(gl_WorkGroupID);
    if (item >= counters.assign_keys) return;
    if (gl_LocalInvocationIndex == 0u) claim(new_slots[item]);
    barrier();
    const uint quads = 1u << 3u * frame.edge_shift >> 2u;
    if (block == kNoBlock || gl_LocalInvocationIndex >= quads) return;
    record_table[block * quads + gl_LocalInvocationIndex] = uvec4(kNoRecord);
}
