// The keyframes least dissimilar to a frame, in order; of equals the older one first. One group.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/tracking/keyframes.h"

layout(local_size_x = kRankGroup) in;
layout(std430, binding = 0) readonly buffer Dissimilarities { float dissimilarities[]; };
layout(std430, binding = 1) readonly buffer Keyframes { Keyframe keyframes[]; };
layout(std430, binding = 2) readonly buffer Counters { KeyframeCounters counters; };
layout(std430, binding = 3) writeonly buffer Matches { KeyframeMatch matches[]; };
layout(push_constant) uniform Push { RankKeyframesParams params; };

shared float values[kRankGroup];
shared uint slots[kRankGroup];

bool before(float a, uint slot_a, float b, uint slot_b) { return a < b || (a == b && slot_a < slot_b); }

// The first in the order after the given one, of this invocation's slots.
void find_own(float last, uint last_slot, bool first) {
    const uint lane = gl_LocalInvocationIndex;
    float value = 2.0;
    uint best = kNoKeyframe;
    for (uint slot = lane; slot < min(counters.used, params.capacity); slot += kRankGroup) {
        const float own = dissimilarities[slot];
        if ((first || before(last, last_slot, own, slot)) && before(own, slot, value, best)) {
            value = own;
            best = slot;
        }
    }
    values[lane] = value;
    slots[lane] = best;
}

void reduce() {
    const uint lane = gl_LocalInvocationIndex;
    barrier();
    for (uint half_size = kRankGroup / 2u; half_size > 0u; half_size /= 2u) {
        if (lane < half_size && before(values[lane + half_size], slots[lane + half_size], values[lane], slots[lane])) {
            values[lane] = values[lane + half_size];
            slots[lane] = slots[lane + half_size];
        }
        barrier();
    }
}

KeyframeMatch match_of(uint slot, float dissimilarity) {
    KeyframeMatch found;
    found.world_from_camera = mat4(0.0);
    found.dissimilarity = 0.0;
    found.slot = slot;
    found.frame = 0u;
    found.pad0 = 0u;
    if (slot == kNoKeyframe) return found;
    found.world_from_camera = keyframes[slot].world_from_camera;
    found.dissimilarity = dissimilarity;
    found.frame = keyframes[slot].frame;
    return found;
}

void main() {
    float last = 0.0;
    uint last_slot = kNoKeyframe;
    for (uint i = 0u; i < params.matches; ++i) {
        if (i == 0u || last_slot != kNoKeyframe) {
            find_own(last, last_slot, i == 0u);
            reduce();
            last = values[0];
            last_slot = slots[0];
            barrier();
        }
        if (gl_LocalInvocationIndex == 0u) matches[i] = match_of(last_slot, last);
    }
}
