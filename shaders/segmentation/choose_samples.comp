#version 460
#extension GL_GOOGLE_include_directive : require
// Chooses each segment's lowest level so that what is of it or above fits, first of the records with enough
// observations, then of the others. Begins the sums of its albedo.
#include "shared/segmentation/segment_samples.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Levels { uint levels[]; };  // twice kSampleLevels per label
layout(std430, binding = 1) writeonly buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 2) writeonly buffer SegmentKds { SegmentKd kds[]; };
layout(push_constant) uniform Push { SegmentSampleParams params; };

struct Choice {
    uint kept;
    uint eligible;
    uint lowest;  // level
};

Choice choose(uint table, uint room) {
    Choice choice = Choice(0u, 0u, kSampleLevels);
    for (int i = int(kSampleLevels) - 1; i >= 0; --i) {
        choice.eligible += levels[table * kSampleLevels + uint(i)];
        const bool fits = choice.lowest == uint(i) + 1u && choice.eligible <= room;
        choice.kept = fits ? choice.eligible : choice.kept;
        choice.lowest = fits ? uint(i) : choice.lowest;
    }
    return choice;
}

void main() {
    const uint label = gl_GlobalInvocationID.x;
    if (label >= params.labels) return;
    const Choice well = choose(2u * label, kSegmentSamples);
    const Choice sparsely = choose(2u * label + 1u, kSegmentSamples - well.kept);
    kds[label] = SegmentKd(0u, 0u, 0u, 0u);
    counts[label] =
        SegmentSampleCount(well.kept + sparsely.kept, well.eligible + sparsely.eligible, well.lowest, sparsely.lowest);
}
