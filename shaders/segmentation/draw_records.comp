#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per segment: draws records of those that it keeps, without putting back. The draw is a random order by
// hash, so that the order in which they are kept does not matter.
#include "lib/segments/segment_samples.glsl"

layout(local_size_x = kDrawGroup) in;
layout(std430, binding = 0) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 1) readonly buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 2) readonly buffer Kept { uint kept[]; };
layout(std430, binding = 3) buffer Drawn { uint drawn[]; };  // draws per label, kNoRecord at first
layout(push_constant) uniform Push { SegmentSampleParams params; };

shared uint hashes[kSegmentSamples];
shared uint keys[kSegmentSamples];
shared uint voxels[kSegmentSamples];

// Two voxels may have one hash, though hardly ever.
bool is_before(uint a, uint b) {
    if (hashes[a] != hashes[b]) return hashes[a] < hashes[b];
    return keys[a] != keys[b] ? keys[a] < keys[b] : voxels[a] < voxels[b];
}

void main() {
    const uint label = gl_WorkGroupID.y * kGroupsPerRow + gl_WorkGroupID.x;
    if (label >= params.labels) return;
    const uint count = counts[label].kept;
    if (count < params.draws) return;
    const uint first = label * kSegmentSamples;
    for (uint i = gl_LocalInvocationIndex; i < count; i += kDrawGroup) {
        const VoxelRecord record = records[kept[first + i]];
        hashes[i] = sample_hash(record, params.seed);
        keys[i] = record.block_key;
        voxels[i] = voxel_in_block(record);
    }
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < count; i += kDrawGroup) {
        uint rank = 0u;
        for (uint other = 0u; other < count; ++other) rank += is_before(other, i) ? 1u : 0u;
        if (rank < params.draws) drawn[label * params.draws + rank] = kept[first + i];
    }
}
