#version 460
#extension GL_GOOGLE_include_directive : require
// Makes a longer ring of the ring of free labels, and adds the new labels behind those that were free before. One
// workgroup: what lay at the ring's beginning, behind its end, has to be moved before new labels take its place.
#include "shared/observation/grow_pool.h"
#include "shared/segmentation/segments.h"

layout(local_size_x = kGrowGroup) in;
layout(std430, binding = 0) coherent buffer FreeLabels { uint free_labels[]; };
layout(std430, binding = 1) buffer Counters { SegmentCounters counters; };
layout(push_constant) uniform Push { GrowParams params; };

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint capacity = params.before + params.added;
    const uint end = counters.free_head + counters.free_labels;
    const uint wrapped = max(end, params.before) - params.before;
    // Not all of them may fit behind the old end: a lane reads and writes in order, and a later label's place was read
    // in a step before.
    for (uint first = 0u; first < wrapped; first += kGrowGroup) {
        const uint label = first + lane < wrapped ? free_labels[first + lane] : 0u;
        barrier();
        if (first + lane < wrapped) free_labels[(params.before + first + lane) % capacity] = label;
        memoryBarrierBuffer();
        barrier();
    }
    for (uint i = lane; i < params.added; i += kGrowGroup) free_labels[(end + i) % capacity] = params.before + i;
    barrier();
    if (lane != 0u) return;
    counters.free_labels += params.added;
    counters.capacity = capacity;
}
