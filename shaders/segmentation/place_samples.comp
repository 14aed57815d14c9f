#version 460
#extension GL_GOOGLE_include_directive : require
// Where the records lie that each segment keeps: the key of the block, and the voxel within it.
#include "lib/segments/segment_samples.glsl"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 1) readonly buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 2) readonly buffer Kept { uint kept[]; };        // kSegmentSamples per label
layout(std430, binding = 3) writeonly buffer Places { uvec2 places[]; };  // likewise
layout(push_constant) uniform Push { SegmentSampleParams params; };

void main() {
    const uint label = gl_GlobalInvocationID.x;
    if (label >= params.labels) return;
    const uint first = label * kSegmentSamples;
    for (uint i = 0u; i < kSegmentSamples; ++i) {
        uvec2 place = uvec2(kEmptyKey, 0u);
        if (i < counts[label].kept) {
            const VoxelRecord record = records[kept[first + i]];
            place = uvec2(record.block_key, voxel_in_block(record));
        }
        places[first + i] = place;
    }
}
