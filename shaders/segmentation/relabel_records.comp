#version 460
#extension GL_GOOGLE_include_directive : require
// Of the observations' blocks, those whose keys have their turn in this frame: replaces their records' labels by their
// roots, as sweep_labels.comp does with voxels. A group looks at kSweepGroup block ids.
#include "lib/map/voxel_map.glsl"
#include "lib/records/observations.glsl"
#include "shared/segmentation/segments.h"

layout(local_size_x = kSweepGroup) in;
layout(std430, binding = 0) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 1) readonly buffer Counters { MapCounters counters; };
layout(std430, binding = 2) readonly buffer RecordTable { uint record_table[]; };
layout(std140, binding = 3) uniform Segmentation { SegmentationParams frame; };
layout(binding = 4, r32ui) uniform readonly uimageBuffer Parents;
layout(std430, binding = 5) buffer Records { VoxelRecord records[]; };
layout(push_constant) uniform Push { RelabelParams params; };

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= counters.high_water) return;
    const uint key = block_keys[block];
    if (key == kEmptyKey || hash_of_key(key) % kSweepParts != frame.stamp / kSweepEvery % kSweepParts) return;
    const uint count = 1u << 3u * params.edge_shift;
    for (uint i = 0u; i < count; ++i) {
        const uint record = record_table[block * count + i];
        if (record >= kNewRecord) continue;
        const uint label = record_label(records[record]);
        const uint root = imageLoad(Parents, int(label)).x;
        if (root != label) records[record].label = root == kNoLabel ? 0u : (records[record].label & ~0xffffu) | root;
    }
}
