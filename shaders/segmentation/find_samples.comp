#version 460
#extension GL_GOOGLE_include_directive : require
// Which records lie where each segment's samples lay: its samples from now on. Places without a record are dropped.
#include "shared/segmentation/segment_samples.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Places { uvec2 places[]; };  // kSegmentSamples per label
layout(std430, binding = 1) readonly buffer Keys { uvec4 keys[]; };
layout(std430, binding = 2) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 3) readonly buffer RecordTable { uint record_table[]; };
layout(std430, binding = 4) buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 5) writeonly buffer Kept { uint kept[]; };  // kSegmentSamples per label
layout(push_constant) uniform Push { FoundSamplesParams params; };
#define KEYS(bucket) keys[bucket]
#define BLOCK(slot) blocks[slot]
#define RECORD(entry) record_table[entry]
#include "lib/records/find_record.glsl"

void main() {
    const uint label = gl_GlobalInvocationID.x;
    if (label >= params.labels) return;
    const uint first = label * kSegmentSamples;
    uint found = 0u;
    for (uint i = 0u; i < counts[label].kept; ++i) {
        const uvec2 place = places[first + i];
        const ivec3 block = block_of_key(params.records, place.x);
        const uint record =
            find_record(params.records, params.edge_shift, voxel_of_record(block, place.y, params.edge_shift));
        if (record != kNoRecord) kept[first + found++] = record;
    }
    counts[label].kept = found;
}
