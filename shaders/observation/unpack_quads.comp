#version 460
#extension GL_GOOGLE_include_directive : require
// Copies the directions, or the colours, of records that came back into their chunks. A group takes as many records as
// it has invocations.
#include "lib/map/voxel_chunks.glsl"
#include "shared/observation/stream_records.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Entered { uint entered[]; };  // record ids; kNoRecord: not entered
layout(std430, binding = 1) buffer Words { uvec4 quads[]; }
words[kMaxVoxelChunks];
layout(std430, binding = 6) readonly buffer Packed { uvec4 packed_quads[]; };
layout(push_constant) uniform Push { CopyRecordsParams params; };

void main() {
    const uint end = params.count * kRecordQuads;
    uint item = gl_WorkGroupID.x * kRecordGroup * kRecordQuads + gl_LocalInvocationIndex;
    for (uint i = 0u; i < kRecordQuads && item < end; ++i, item += kRecordGroup) {
        const uint record = entered[item / kRecordQuads];
        if (record == kNoRecord) continue;
        const uint to = index_in_chunk(params.chunk_shift, record) * kRecordQuads + item % kRecordQuads;
#define UNPACK(C) words[C].quads[to] = packed_quads[item]
        WITH_CHUNK(params.chunk_shift, record, UNPACK)
    }
}
