#version 460
#extension GL_GOOGLE_include_directive : require
// The segments that a frame estimates: by turns the one that changed most, and the one that has waited longest, of
// those that changed at all and have samples; and which of these the fit is not sure of. Forgets what is known of
// labels that were handed out anew. One workgroup.
#include "shared/segmentation/segment_samples.h"
#include "shared/segmentation/segments.h"
#include "shared/specular/mirror_fit.h"
#include "shared/specular/specular_estimates.h"

layout(local_size_x = kChooseSegmentsGroup) in;
layout(std430, binding = 0) readonly buffer Labels { SegmentLabel labels[]; };
layout(std430, binding = 1) readonly buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 2) coherent buffer Progress { SegmentProgress progress[]; };
layout(std430, binding = 3) coherent buffer Fits { WardFit fits[]; };
layout(std430, binding = 4) buffer Means { PerceptualMaterial means[]; };
layout(std430, binding = 5) buffer Estimates { WardMaterial estimates[]; };
layout(std430, binding = 6) buffer Materials { SegmentMaterial materials[]; };
layout(std430, binding = 7) writeonly buffer Batch { uint batch[]; };        // count, then labels
layout(std430, binding = 8) writeonly buffer Doubtful { uint doubtful[]; };  // likewise, of those
layout(std430, binding = 9) writeonly buffer Mirrors { MirrorFit mirrors[]; };
layout(push_constant) uniform Push { ChooseSegmentsParams params; };

const uint kGroup = kChooseSegmentsGroup;

shared uvec2 candidates[kGroup];  // how urgent, label

void forget(uint label) {
    fits[label] = WardFit(vec4(0.0), vec4(0.0), 0.0, 0.0, 0u, 0u, vec4(0.0), vec4(0.0), vec4(0.0));
    mirrors[label] = MirrorFit(vec4(0.0), vec4(0.0), 0.0, 0.0, 0u, 0u);
    means[label] = PerceptualMaterial(vec4(0.0), vec4(0.0));
    estimates[label] = WardMaterial(vec4(0.0), vec4(0.0));
    if (label >= params.materials) return;
    const uint version = materials[label].version;
    if (version != 0u)
        materials[label] = SegmentMaterial(vec4(0.0, 0.0, 0.0, 1.0), version % 0xffffu + 1u, 0.0, 0.0, 0u);
}

// Merging makes a label older, never younger.
void renew() {
    for (uint label = 1u + gl_LocalInvocationIndex; label < params.labels; label += kGroup) {
        const uint since = labels[label].since;
        if (labels[label].state != kLiveLabel || since <= progress[label].since) continue;
        if (progress[label].since != 0u) {
            forget(label);
            progress[label].changes = max(progress[label].changes, 1u);  // what was split may not be seen again
        }
        progress[label].since = since;
        progress[label].estimated = 0u;
    }
}

uint urgency(uint label, bool by_age) {
    const SegmentProgress waits = progress[label];
    const bool due = waits.changes > 0u && waits.estimated != params.stamp && counts[label].kept > 0u &&
                     labels[label].state == kLiveLabel;
    return due ? (by_age ? params.stamp - waits.estimated : waits.changes) : 0u;
}

bool is_more_urgent(uvec2 a, uvec2 b) { return a.x != b.x ? a.x > b.x : a.y < b.y; }

uvec2 most_urgent(bool by_age) {
    uvec2 best = uvec2(0u);
    for (uint label = 1u + gl_LocalInvocationIndex; label < params.labels; label += kGroup) {
        const uvec2 candidate = uvec2(urgency(label, by_age), label);
        if (is_more_urgent(candidate, best)) best = candidate;
    }
    candidates[gl_LocalInvocationIndex] = best;
    barrier();
    for (uint half_group = kGroup / 2u; half_group > 0u; half_group /= 2u) {
        const uint lane = gl_LocalInvocationIndex;
        if (lane < half_group && is_more_urgent(candidates[lane + half_group], candidates[lane]))
            candidates[lane] = candidates[lane + half_group];
        barrier();
    }
    return candidates[0];
}

void main() {
    renew();
    uint count = 0u, doubts = 0u;
    for (uint i = 0u; i < params.capacity; ++i) {
        memoryBarrierBuffer();
        barrier();
        const uvec2 chosen = most_urgent(i % 2u == 1u);
        if (chosen.x == 0u) break;
        if (gl_LocalInvocationIndex == 0u) {
            batch[1u + count] = chosen.y;
            progress[chosen.y].changes = 0u;
            progress[chosen.y].estimated = params.stamp;
            if (!(fits[chosen.y].confidence >= kAskedBelowConfidence)) doubtful[++doubts] = chosen.y;
        }
        ++count;
    }
    if (gl_LocalInvocationIndex != 0u) return;
    batch[0] = count;
    doubtful[0] = doubts;
}
