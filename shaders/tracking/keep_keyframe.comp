// Stores a frame as a keyframe if it was tracked well, and looks like none of them or is near none. One group.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/tracking/keyframes.h"

layout(local_size_x = kFernWords) in;
layout(std430, binding = 0) readonly buffer Code { uint words[]; };
layout(std430, binding = 1) readonly buffer Candidate { KeyframeCandidate candidate; };
layout(std430, binding = 2) readonly buffer Matches { KeyframeMatch matches[]; };
layout(std430, binding = 3) buffer Codes { uint stored_words[]; };
layout(std430, binding = 4) buffer Keyframes { Keyframe keyframes[]; };
layout(std430, binding = 5) buffer Counters { KeyframeCounters counters; };
layout(push_constant) uniform Push { KeepKeyframeParams params; };

shared uint known[kFernWords];
shared uint near[kFernWords];

uint count_known(uint word) {
    uint count = 0u;
    for (uint shift = 0u; shift < 32u; shift += 8u) {
        if ((word >> shift & kFernHasDepth) != 0u) ++count;
    }
    return count;
}

bool is_near(mat4 a, mat4 b) {
    // The trace of the rotation from one to the other is 1 + 2 cos(angle).
    float trace = 0.0;
    for (int i = 0; i < 3; ++i) trace += dot(a[i].xyz, b[i].xyz);
    return distance(a[3].xyz, b[3].xyz) < params.near_m && trace > 1.0 + 2.0 * params.near_cosine;
}

uint count_near(uint lane) {
    uint count = 0u;
    for (uint slot = lane; slot < counters.used; slot += kFernWords) {
        if (is_near(keyframes[slot].world_from_camera, candidate.world_from_camera)) ++count;
    }
    return count;
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint word = words[lane];
    known[lane] = count_known(word);
    near[lane] = count_near(lane);
    const uint slot = counters.used;
    barrier();
    for (uint half_size = kFernWords / 2u; half_size > 0u; half_size /= 2u) {
        if (lane < half_size) {
            known[lane] += known[lane + half_size];
            near[lane] += near[lane + half_size];
        }
        barrier();
    }
    const bool is_new = near[0] == 0u || matches[0].dissimilarity > params.least_dissimilarity;
    if (candidate.well_tracked == 0u || !is_new || known[0] < params.least_ferns) return;
    if (slot >= params.capacity) {
        if (lane == 0u) ++counters.refused;
        return;
    }
    stored_words[slot * kFernWords + lane] = word;
    if (lane > 0u) return;
    keyframes[slot] = Keyframe(candidate.world_from_camera, candidate.frame, 0u, 0u, 0u);
    counters.used = slot + 1u;
}
