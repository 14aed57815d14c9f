#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per segment: of the records that it keeps, takes out those that were given back.
#include "shared/segmentation/segment_samples.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 1) buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 2) buffer Kept { uint kept[]; };  // kSegmentSamples per label
layout(push_constant) uniform Push { SegmentSampleParams params; };

void main() {
    const uint label = gl_GlobalInvocationID.x;
    if (label >= params.labels) return;
    const uint first = label * kSegmentSamples;
    uint left = 0u;
    for (uint i = 0u; i < counts[label].kept; ++i) {
        const uint record = kept[first + i];
        if (records[record].block_key != kEmptyKey) kept[first + left++] = record;
    }
    counts[label].kept = left;
}
