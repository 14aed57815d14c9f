#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per segment of a batch: which of the records that it keeps are fitted, in an order that is the same in
// every run, so that sums over them are, too. Records left out leave gaps.
#include "lib/reflectance.glsl"
#include "shared/ward_fit.h"

layout(local_size_x = kDrawGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 3) readonly buffer Kept { uint kept[]; };
layout(std430, binding = 4) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 5) readonly buffer Status { RecordStatus status[]; };
layout(std430, binding = 6) writeonly buffer Voxels { uint voxels[]; };  // kSegmentSamples per segment
layout(push_constant) uniform Push { FitParams params; };

shared uvec2 places[kSegmentSamples];

// Voxels that some light may reach only in part count too: faces whose sides were never seen have no others.
bool is_lit(uint record) {
    return is_marched(status[record].marched, params.position_version) && any(notEqual(visibility[record], uvec2(0u)));
}

bool is_before(uvec2 a, uvec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

void main() {
    const uint segment = gl_WorkGroupID.x;
    const uint label = batch[1u + segment];
    const uint count = label < params.labels ? min(counts[label].kept, kSegmentSamples) : 0u;
    for (uint i = gl_LocalInvocationIndex; i < count; i += kDrawGroup) {
        const VoxelRecord record = records[kept[label * kSegmentSamples + i]];
        places[i] = uvec2(record.block_key, voxel_in_block(record));
    }
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < kSegmentSamples; i += kDrawGroup) {
        uint rank = i, chosen = kNoRecord;
        if (i < count) {
            rank = 0u;
            for (uint other = 0u; other < count; ++other) rank += is_before(places[other], places[i]) ? 1u : 0u;
            const uint record = kept[label * kSegmentSamples + i];
            if (record_label(records[record]) == label && is_lit(record)) chosen = record;
        }
        voxels[segment * kSegmentSamples + rank] = chosen;
    }
}
