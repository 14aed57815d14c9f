#version 460
#extension GL_GOOGLE_include_directive : require
// Chooses each segment's lowest level so that what is of it or above fits. Begins the sums of its albedo.
#include "shared/segmentation/segment_samples.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Levels { uint levels[]; };
layout(std430, binding = 1) writeonly buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 2) writeonly buffer SegmentKds { SegmentKd kds[]; };
layout(push_constant) uniform Push { SegmentSampleParams params; };

void main() {
    const uint label = gl_GlobalInvocationID.x;
    if (label >= params.labels) return;
    uint kept = 0u, eligible = 0u, lowest = kSampleLevels;
    for (int i = int(kSampleLevels) - 1; i >= 0; --i) {
        eligible += levels[label * kSampleLevels + uint(i)];
        const bool fits = lowest == uint(i) + 1u && eligible <= kSegmentSamples;
        kept = fits ? eligible : kept;
        lowest = fits ? uint(i) : lowest;
    }
    kds[label] = SegmentKd(0u, 0u, 0u, 0u);
    counts[label] = SegmentSampleCount(kept, eligible, lowest, 0u);
}
