#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Sums up the albedo of each segment over its records, and counts these and their observations.
#include "lib/records/segment_albedo.glsl"

layout(local_size_x = kRecordGroup) in;
layout(constant_id = 0) const uint kRecordsPerItem = 1u;  // a group of the dispatch has as many groups of records
layout(std430, binding = 0) readonly buffer RecordCounters { MapCounters counters; };
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer Albedo { uvec2 albedo[]; };
layout(std430, binding = 3) buffer Segments { SegmentAlbedo segments[]; };

void add_record(uint record) {
    const uint label = record_label(records[record]);
    if (label == 0u || label >= uint(segments.length())) return;
    const SegmentAlbedo sums = albedo_sums(records[record], albedo[record]);
    atomicAdd(segments[label].kd.w, sums.kd.w);
    atomicAdd(segments[label].weight.w, sums.weight.w);
    if (sums.weight.rgb == uvec3(0u)) return;
    [[unroll]] for (int c = 0; c < 3; ++c) {
        atomicAdd(segments[label].kd[c], sums.kd[c]);
        atomicAdd(segments[label].weight[c], sums.weight[c]);
    }
}

void main() {
    const uint end = counters.high_water;
    uint record = gl_WorkGroupID.x * kRecordsPerItem * kRecordGroup + gl_LocalInvocationID.x;
    for (uint i = 0u; i < kRecordsPerItem && record < end; ++i, record += kRecordGroup) add_record(record);
}
