#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Finds the closest pair of a full record's directions anew, for records whose last one lost a member. Of pairs as
// close, the one whose later member comes first, then the earlier one.
#include "lib/records/observations.glsl"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Stale { uint stale[]; };
layout(std430, binding = 1) buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(push_constant) uniform Push { VoxelGrid grid; };

#include "lib/records/record_directions.glsl"

void main() {
    const uint entry = gl_GlobalInvocationID.x;
    if (entry >= stale[0]) return;
    const uint record = stale[1u + entry];
    float closest = kFarApart;
    uvec2 pair = uvec2(0u);
    for (uint later = 1u; later < kMaxObservations; ++later) {
        const vec3 at = direction_on_grid(load_direction(grid.chunk_shift, record, later));
        for (uint quad = 0u; 4u * quad < later; ++quad) {
            const uvec4 words = load_directions(grid.chunk_shift, record, quad);
            [[unroll]] for (uint i = 0u; i < 4u; ++i) {
                const uint item = 4u * quad + i;
                const float distance2 = item < later ? grid_distance2(direction_on_grid(words[i]), at) : kFarApart;
                pair = distance2 < closest ? uvec2(item, later) : pair;
                closest = min(closest, distance2);
            }
        }
    }
    const uint last = index_in_chunk(grid.chunk_shift, record) * kRecordQuads + kRecordQuads - 1u;
#define STORE(C) directions[C].quads[last].zw = uvec2(floatBitsToUint(closest), pair.x | pair.y << 8)
    WITH_CHUNK(grid.chunk_shift, record, STORE)
}
