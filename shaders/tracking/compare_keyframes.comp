// How much a frame's code differs from each stored keyframe's, a group each: the share of differing ferns among those
// whose depth both know (Glocker et al. 2015, BlockHD); colours count where both know them. Counts are whole numbers,
// so that their order does not matter.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/tracking/keyframes.h"

layout(local_size_x = kFernGroup) in;
layout(std430, binding = 0) readonly buffer Code { uint words[]; };
layout(std430, binding = 1) readonly buffer Codes { uint stored_words[]; };
layout(std430, binding = 2) readonly buffer Counters { KeyframeCounters counters; };
layout(std430, binding = 3) writeonly buffer Dissimilarities { float dissimilarities[]; };
layout(push_constant) uniform Push { CompareKeyframesParams params; };

const uint kColorTests = kFernRed | kFernGreen | kFernBlue;

shared uvec2 counts[kFernGroup];  // ferns that both know, and that differ

uvec2 compare(uint a, uint b) {
    uvec2 count = uvec2(0u);
    for (uint shift = 0u; shift < 32u; shift += 8u) {
        const uint known = (a & b) >> shift;
        uint tests = params.tests;
        if ((known & kFernHasColor) == 0u) tests &= ~kColorTests;
        const bool differs = ((a ^ b) >> shift & tests) != 0u;
        if ((known & kFernHasDepth) != 0u) count += uvec2(1u, differs ? 1u : 0u);
    }
    return count;
}

void main() {
    const uint slot = gl_WorkGroupID.x;
    const uint lane = gl_LocalInvocationIndex;
    uvec2 count = uvec2(0u);
    const bool used = slot < counters.used;
    if (used) {
        for (uint word = lane; word < kFernWords; word += kFernGroup)
            count += compare(words[word], stored_words[slot * kFernWords + word]);
    }
    counts[lane] = count;
    barrier();
    for (uint half_size = kFernGroup / 2u; half_size > 0u; half_size /= 2u) {
        if (lane < half_size) counts[lane] += counts[lane + half_size];
        barrier();
    }
    if (lane > 0u) return;
    const uvec2 total = counts[0];
    dissimilarities[slot] = used && total.x >= params.least_ferns ? float(total.y) / float(total.x) : 1.0;
}
