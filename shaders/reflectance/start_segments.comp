#version 460
#extension GL_GOOGLE_include_directive : require
// Begins the sums of each segment's albedo with what is away from the device.
#include "shared/reflectance/reflectance.h"
#include "shared/segmentation/segments.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Away { SegmentAlbedo away[]; };  // kSweepParts per label
layout(std430, binding = 1) writeonly buffer Segments { SegmentAlbedo segments[]; };

void main() {
    const uint label = gl_GlobalInvocationID.x;
    if (label >= uint(segments.length())) return;
    SegmentAlbedo sums = SegmentAlbedo(uvec4(0u), uvec4(0u));
    for (uint part = 0u; part < kSweepParts; ++part) {
        sums.kd += away[label * kSweepParts + part].kd;
        sums.weight += away[label * kSweepParts + part].weight;
    }
    segments[label] = sums;
}
