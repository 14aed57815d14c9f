#version 460
#extension GL_GOOGLE_include_directive : require
// Counts the voxels of each label that are away from the device, as sweep_labels.comp counts those on it.
#include "shared/segmentation/segments.h"

layout(local_size_x = kSweepGroup) in;
layout(std430, binding = 0) readonly buffer Parents { uint parents[]; };
layout(std430, binding = 1) readonly buffer Away { uint away[]; };  // voxels by label
layout(std430, binding = 2) buffer Labels { SegmentLabel labels[]; };

void main() {
    const uint label = gl_GlobalInvocationID.x;
    if (label >= uint(away.length()) || away[label] == 0u) return;
    const uint root = parents[label];
    if (root != kNoLabel) atomicAdd(labels[root].tally, away[label]);
}
