#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup: decides which of this frame's new keys get a block. While the pool suffices, all do. Else the keys
// whose hash falls into the first bins do, as many whole bins as fit: the choice depends on the keys alone, not on who
// came first.
#include "lib/voxel_map.glsl"
#include "shared/allocate_blocks.h"

layout(local_size_x = kSelectGroup) in;
layout(std430, binding = 0) readonly buffer Keys { uint keys[]; };
layout(std430, binding = 1) readonly buffer NewSlots { uint new_slots[]; };
layout(std430, binding = 2) buffer Counters { MapCounters counters; };
layout(std430, binding = 3) writeonly buffer AssignArguments { uvec4 assign_arguments; };
layout(std430, binding = 4) writeonly buffer BlockArguments { uvec4 block_arguments; };
layout(std140, binding = 5) uniform Fusion { FusionParams fusion; };

shared uint bins[kAcceptBins];

void count_bins(uint total) {
    for (uint i = gl_LocalInvocationIndex; i < kAcceptBins; i += kSelectGroup) bins[i] = 0u;
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < total; i += kSelectGroup) {
        atomicAdd(bins[hash_of_key(keys[new_slots[i]]) / (0xffffffffu / kAcceptBins + 1u)], 1u);
    }
    barrier();
}

void main() {
    const uint total = counters.new_keys;
    const uint available = counters.free_blocks;
    const bool scarce = total > available;
    if (scarce) count_bins(total);
    if (gl_LocalInvocationIndex != 0u) return;

    uint accepted = total;
    uint accepted_bins = kAcceptBins;
    if (scarce) {
        accepted = 0u;
        for (accepted_bins = 0u; accepted_bins < kAcceptBins; ++accepted_bins) {
            if (accepted + bins[accepted_bins] > available) break;
            accepted += bins[accepted_bins];
        }
    }
    counters.accepted_bins = accepted_bins;
    counters.claim_base = available;
    counters.claimed = 0u;
    counters.free_blocks = available - accepted;
    counters.high_water = max(counters.high_water, fusion.grid.capacity - (available - accepted));
    counters.table_keys += total;
    counters.refused_blocks += total - accepted;
    counters.assign_keys = total;
    counters.new_keys = 0u;
    assign_arguments = uvec4(kGroupsPerRow, (total + kGroupsPerRow - 1u) / kGroupsPerRow, 1u, 0u);
    block_arguments = uvec4((counters.high_water + kAssignGroup - 1u) / kAssignGroup, 1u, 1u, 0u);
}
