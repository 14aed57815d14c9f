#version 460
#extension GL_GOOGLE_include_directive : require
// Copies the first records' observations into their chunks.
#include "lib/map/voxel_chunks.glsl"
#include "shared/test/test_observations.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 5) buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(std430, binding = 10) readonly buffer GivenDirections { uvec4 given_directions[]; };
layout(std430, binding = 11) readonly buffer GivenColors { uvec4 given_colors[]; };
layout(push_constant) uniform Push { TestObservationParams params; };

void main() {
    const uint record = gl_GlobalInvocationID.x;
    if (record >= params.records) return;
    const uint first = index_in_chunk(params.grid.chunk_shift, record) * kRecordQuads;
    for (uint quad = 0u; quad < kRecordQuads; ++quad) {
        const uint given = record * kRecordQuads + quad;
#define STORE_QUADS(C)                                           \
    directions[C].quads[first + quad] = given_directions[given]; \
    colors[C].quads[first + quad] = given_colors[given]
        WITH_CHUNK(params.grid.chunk_shift, record, STORE_QUADS)
    }
}
