// Numbers the components that have enough pixels, in the order of their keys, and begins their entries in the table.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/segmentation/number_segments.h"

layout(local_size_x = kNumberGroup) in;
layout(std430, binding = 0) readonly buffer Pixels { uvec4 pixels[]; };  // by key, four at a time
layout(std430, binding = 1) readonly buffer Totals { KeyTotals totals[]; };
layout(std430, binding = 2) writeonly buffer Numbers { uint numbers[]; };  // by key; only where enough pixels are
layout(std430, binding = 3) buffer Segments { FrameSegment segments[]; };  // all 0 before
layout(std430, binding = 4) writeonly buffer Count { FrameSegmentCount count; };
layout(push_constant) uniform Push { NumberSegmentsParams params; };

shared uint sums[kNumberGroup];
shared uint kept_before;
shared uint kept;
shared uint too_small;

// A key that was joined to another has none of its own.
uvec4 key_pixels(uvec4 counts) { return mix(counts, uvec4(0u), greaterThanEqual(counts, uvec4(kForwardedKey))); }

// The sum of the values of all invocations before this one. Called by all invocations of a group.
uint exclusive_sum(uint value) {
    const uint i = gl_LocalInvocationIndex;
    sums[i] = value;
    barrier();
    for (uint step = 1u; step < kNumberGroup; step *= 2u) {
        const uint other = i >= step ? sums[i - step] : 0u;
        barrier();
        sums[i] += other;
        barrier();
    }
    return sums[i] - value;
}

void add_totals() {
    uint before = 0u, all = 0u, small = 0u;
    for (uint group = gl_LocalInvocationIndex; group < params.groups; group += kNumberGroup) {
        const KeyTotals total = totals[group];
        before += group < gl_WorkGroupID.x ? total.kept : 0u;
        all += total.kept;
        small += total.too_small;
    }
    if (gl_LocalInvocationIndex == 0u) kept_before = kept = too_small = 0u;
    barrier();
    atomicAdd(kept_before, before);
    atomicAdd(kept, all);
    atomicAdd(too_small, small);
    barrier();
}

void begin_segment(uint key, uint number) {
    const bool placed = number <= params.capacity;
    numbers[key] = placed ? number : 0u;
    if (placed) {
        segments[number] = FrameSegment(0u, key, 0u, 0u);
    }
}

void main() {
    add_totals();
    if (gl_GlobalInvocationID.x == 0u) {
        const uint placed = min(kept, params.capacity);
        count = FrameSegmentCount(placed, too_small, kept - placed, 0u);
    }
    const uint first = gl_GlobalInvocationID.x * kNumberQuads;
    uvec4 enough = uvec4(0u);
    for (uint i = 0u; i < kNumberQuads; ++i) {
        enough += uvec4(greaterThanEqual(key_pixels(pixels[first + i]), uvec4(params.min_pixels)));
    }
    const uint here = enough.x + enough.y + enough.z + enough.w;
    uint number = kept_before + exclusive_sum(here);
    // The loop ends for whole groups of invocations that have nothing to number.
    const uint last = number + here;
    for (uint i = 0u; number < last; ++i) {
        const uvec4 counts = key_pixels(pixels[first + i]);
        [[unroll]] for (uint k = 0u; k < 4u; ++k) {
            if (counts[k] < params.min_pixels) continue;
            begin_segment((first + i) * 4u + k, ++number);
        }
    }
}
