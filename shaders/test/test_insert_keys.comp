#version 460
#extension GL_GOOGLE_include_directive : require
// Inserts a list of keys, with repetitions, and says for each where it is and whether this invocation put it there.
#include "shared/test/test_voxel_map.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer List { uint list[]; };
layout(std430, binding = 1) coherent buffer Keys { uint keys[]; };
layout(std430, binding = 2) writeonly buffer Insertions { uvec2 insertions[]; };  // slot, fresh
layout(push_constant) uniform Push { TestMapParams params; };
#include "lib/map/insert_key.glsl"

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    const Insertion at = insert_key(params.grid, list[i], true);
    insertions[i] = uvec2(at.slot, at.fresh ? 1u : 0u);
}
