#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Writes a batch's triangles. A vertex's number follows from its edge: vertices of the blocks before, of its block's
// words before, of the bits before.
#include "shared/surface/extract_surface.h"
layout(local_size_x = kSurfaceGroup) in;
layout(std430, binding = 0) readonly buffer Neighbours { uint neighbours[]; };
layout(std430, binding = 1) readonly buffer Cases { uint cases[]; };
layout(std430, binding = 2) readonly buffer Edges { EdgeWord edges[]; };
layout(std430, binding = 3) readonly buffer First { BlockElements first[]; };
layout(std430, binding = 4) readonly buffer Triangles { SurfaceElement triangles[]; };
layout(std430, binding = 5) writeonly buffer Indices { uint indices[]; };
layout(push_constant) uniform Push { SurfaceParams params; };
#define NEIGHBOUR(i) neighbours[i]
#include "lib/map/surface_words.glsl"
#include "lib/map/voxel_map.glsl"

uint vertex_of_edge(uint block, ivec3 cell, uint edge) {
    const ivec3 at = cell + ivec3(edge & 1u, edge >> 1 & 1u, edge >> 2 & 1u);
    const ivec3 within = at & 7;
    const uint voxel = uint(within.z << 6 | within.y << 3 | within.x);
    const uint owner = neighbour_block(block, at >> 3);
    const EdgeWord word = edges[owner * kBlockEdgeWords + (edge >> kCornerBits) * kBlockWords + (voxel >> 5)];
    return first[owner].vertices + word.offset + uint(bitCount(word.bits & ((1u << (voxel & 31u)) - 1u)));
}

void main() {
    const uint item = group_item(gl_WorkGroupID) * kSurfaceGroup + gl_LocalInvocationIndex;
    if (item >= params.items) return;
    const SurfaceElement triangle = triangles[item];
    const ivec3 cell = ivec3(triangle.code & 7u, triangle.code >> 3 & 7u, triangle.code >> 6 & 7u);
    const uint packed = cases[(triangle.code >> 9 & 0xffu) * kCaseStride + 1u + (triangle.code >> 17)];
    [[unroll]] for (uint i = 0u; i < 3u; ++i) {
        const uint edge = packed >> (kCaseEdgeBits * i) & ((1u << kCaseEdgeBits) - 1u);
        indices[3u * item + i] = vertex_of_edge(triangle.block, cell, edge);
    }
}
