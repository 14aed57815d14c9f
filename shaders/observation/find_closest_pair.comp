#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Finds the closest pair of a full record's directions anew, for records whose last one lost a member. Of pairs as
// close, the one whose later member comes first, then the earlier one.
#include "lib/observations.glsl"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Stale { uint stale[]; };
layout(std430, binding = 1) buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(push_constant) uniform Push { VoxelGrid grid; };

#include "lib/record_directions.glsl"

void main() {
    const uint entry = gl_GlobalInvocationID.x;
    if (entry >= stale[0]) return;
    const uint record = stale[1u + entry];
    vec3 stored[kMaxObservations];
    [[unroll]] for (uint quad = 0u; quad < kRecordQuads; ++quad) {
        const uvec4 words = load_directions(grid.chunk_shift, record, quad);
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            if (4u * quad + i < kMaxObservations) stored[4u * quad + i] = direction_on_grid(words[i]);
        }
    }
    float closest = kFarApart;
    uvec2 pair = uvec2(0u);
    for (uint later = 1u; later < kMaxObservations; ++later) {
        const vec3 at = direction_on_grid(load_direction(grid.chunk_shift, record, later));
        float nearest = kFarApart;
        uint nearest_item = 0u;
        [[unroll]] for (uint item = 0u; item < kMaxObservations - 1u; ++item) {
            const float distance2 = item < later ? grid_distance2(stored[item], at) : kFarApart;
            nearest_item = distance2 < nearest ? item : nearest_item;
            nearest = min(nearest, distance2);
        }
        pair = nearest < closest ? uvec2(nearest_item, later) : pair;
        closest = min(closest, nearest);
    }
    const uint last = index_in_chunk(grid.chunk_shift, record) * kRecordQuads + kRecordQuads - 1u;
#define STORE(C) directions[C].quads[last].zw = uvec2(floatBitsToUint(closest), pair.x | pair.y << 8)
    WITH_CHUNK(grid.chunk_shift, record, STORE)
}
