#version 460
#extension GL_GOOGLE_include_directive : require
// Copies the directions, or the colours, of listed records out of their chunks. A group takes as many records as it has
// invocations.
#include "lib/map/voxel_chunks.glsl"
#include "shared/observation/stream_records.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer StreamedRecords { uint streamed_records[]; };
layout(std430, binding = 1) readonly buffer Count { LeavingCount listed; };
layout(std430, binding = 2) readonly buffer Words { uvec4 quads[]; }
words[kMaxVoxelChunks];
layout(std430, binding = 7) writeonly buffer Packed { uvec4 packed_quads[]; };
layout(push_constant) uniform Push { CopyRecordsParams params; };

void main() {
    const uint end = min(listed.records, params.count) * kRecordQuads;
    uint item = gl_WorkGroupID.x * kRecordGroup * kRecordQuads + gl_LocalInvocationIndex;
    for (uint i = 0u; i < kRecordQuads && item < end; ++i, item += kRecordGroup) {
        const uint record = streamed_records[item / kRecordQuads];
        const uint from = index_in_chunk(params.chunk_shift, record) * kRecordQuads + item % kRecordQuads;
#define PACK(C) packed_quads[item] = words[C].quads[from]
        WITH_CHUNK(params.chunk_shift, record, PACK)
    }
}
