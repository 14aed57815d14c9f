#version 460
#extension GL_GOOGLE_include_directive : require
// Of one part of the records that are away from the device: moves each label's sums to its root, as
// relabel_records.comp does with the labels of records. Those of labels that were given up end with them.
#include "shared/reflectance/reflectance.h"
#include "shared/segmentation/segments.h"

layout(local_size_x = kSweepGroup) in;
layout(std430, binding = 0) readonly buffer Parents { uint parents[]; };
layout(std430, binding = 1) buffer Away { SegmentAlbedo away[]; };  // kSweepParts per label
layout(std140, binding = 2) uniform Segmentation { SegmentationParams frame; };

void main() {
    const uint label = gl_GlobalInvocationID.x;
    if (label >= uint(away.length()) / kSweepParts) return;
    const uint root = parents[label];
    if (root == label) return;
    const uint part = frame.stamp / kSweepEvery % kSweepParts;
    // Roots are their own roots: what is added to one is not moved on.
    const uint from = label * kSweepParts + part, to = root * kSweepParts + part;
    const SegmentAlbedo sums = away[from];
    if (sums.kd.w == 0u) return;
    away[from] = SegmentAlbedo(uvec4(0u), uvec4(0u));
    if (root == kNoLabel) return;
    for (int c = 0; c < 4; ++c) {
        atomicAdd(away[to].kd[c], sums.kd[c]);
        atomicAdd(away[to].weight[c], sums.weight[c]);
    }
}
