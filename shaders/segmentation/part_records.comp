#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Gives records of labels that have a partner to that of the two which the map's voxels have at their surface.
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_labels.glsl"
#include "lib/records/reflectance.glsl"
#include "shared/segmentation/split_labels.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer RecordCounters { MapCounters counters; };
layout(std430, binding = 1) buffer Records { VoxelRecord records[]; };
layout(binding = 2, r32ui) uniform readonly uimageBuffer Parents;
layout(binding = 3, r32ui) uniform readonly uimageBuffer Partners;
layout(std430, binding = 4) readonly buffer Keys { uvec4 buckets[]; };
layout(std430, binding = 5) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 6) readonly buffer Words { uint words[]; }
labels[kMaxVoxelChunks];
layout(push_constant) uniform Push { PartRecordsParams params; };
#define KEYS(bucket) buckets[bucket]
#define BLOCK(slot) blocks[slot]
#include "lib/map/block_lookup.glsl"

uint label_at(vec3 point_m) {
    const ivec3 voxel = ivec3(floor(point_m / params.voxels.voxel_m));
    const uint found = find_block(params.voxels, voxel >> 3);
    const uint block = found == kNoBlock ? 0u : found;
    const ivec3 within = voxel & 7;
    const uint index = index_in_chunk(params.voxels.chunk_shift, block) * kBlockVoxels +
                       uint(within.z << 6 | within.y << 3 | within.x);
    uint word;
#define LOAD_WORD(C) word = labels[C].words[index]
    WITH_CHUNK(params.voxels.chunk_shift, block, LOAD_WORD)
    return found == kNoBlock ? kNoLabel : imageLoad(Parents, int(voxel_label(word))).x;
}

void main() {
    const uint id = gl_GlobalInvocationID.x;
    if (id >= counters.high_water) return;
    const VoxelRecord record = records[id];
    if (record.block_key == kEmptyKey) return;
    const uint root = imageLoad(Parents, int(record_label(record))).x;
    const uint partner = imageLoad(Partners, int(root)).x;
    if (partner == kNoLabel) return;
    // As sample_labels_main.glsl asks the map.
    const vec3 point_m = surface_point_m(record, params.records, params.edge_shift);
    const vec3 across_m = surface_normal(record) * (0.75 * params.voxels.voxel_m);
    uint label = label_at(point_m);
    if (label == kNoLabel) label = label_at(point_m - across_m);
    if (label == kNoLabel) label = label_at(point_m + across_m);
    if (label == partner) records[id].label = (record.label & ~0xffffu) | partner;
}
