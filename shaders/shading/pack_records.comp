#version 460
#extension GL_GOOGLE_include_directive : require
// Packs what shading needs of each record.
#include "lib/records/packed_records.glsl"
#include "shared/shading/predict_radiance.h"

layout(local_size_x = kRecordGroup) in;
layout(constant_id = 0) const uint kRecordsPerItem = 1u;  // a group of the dispatch has as many groups of records
layout(std430, binding = 0) readonly buffer RecordCounters { MapCounters counters; };
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer Albedo { uvec2 albedo[]; };
layout(std430, binding = 3) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 4) readonly buffer Status { RecordStatus status[]; };
layout(std430, binding = 5) writeonly buffer Packed { uvec4 packed_records[]; };

void main() {
    const uint end = counters.high_water;
    uint record = gl_WorkGroupID.x * kRecordsPerItem * kRecordGroup + gl_LocalInvocationID.x;
    for (uint i = 0u; i < kRecordsPerItem && record < end; ++i, record += kRecordGroup) {
        packed_records[record] =
            pack_record(records[record], albedo[record], status[record].marched != 0u, visibility[record].x);
    }
}
