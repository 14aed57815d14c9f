#version 460
#extension GL_GOOGLE_include_directive : require
// Copies the first records' observations out of their chunks.
#include "lib/map/voxel_chunks.glsl"
#include "shared/test/test_observations.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 5) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(std430, binding = 10) writeonly buffer GatheredDirections { uvec4 gathered_directions[]; };
layout(std430, binding = 11) writeonly buffer GatheredColors { uvec4 gathered_colors[]; };
layout(push_constant) uniform Push { TestObservationParams params; };
#include "lib/records/record_colors.glsl"
#include "lib/records/record_directions.glsl"

void main() {
    const uint record = gl_GlobalInvocationID.x;
    if (record >= params.records) return;
    for (uint quad = 0u; quad < kRecordQuads; ++quad) {
        gathered_directions[record * kRecordQuads + quad] = load_directions(params.grid.chunk_shift, record, quad);
        gathered_colors[record * kRecordQuads + quad] = load_colors(params.grid.chunk_shift, record, quad);
    }
}
