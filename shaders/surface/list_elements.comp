#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Lists the vertices and the triangles of a batch of blocks, so that the passes after it have one invocation for each.
#include "shared/surface/extract_surface.h"
layout(local_size_x = kSurfaceGroup) in;
layout(std430, binding = 0) readonly buffer Neighbours { uint neighbours[]; };
layout(std430, binding = 1) readonly buffer Inside { uint inside[]; };
layout(std430, binding = 2) readonly buffer Complete { uint complete[]; };
layout(std430, binding = 3) readonly buffer Cases { uint cases[]; };
layout(std430, binding = 4) readonly buffer Edges { EdgeWord edges[]; };
layout(std430, binding = 5) readonly buffer TriangleOffsets { uint triangle_offsets[]; };
layout(std430, binding = 6) readonly buffer Batch { uint batch[]; };  // block ids, in the order of their keys
layout(std430, binding = 7) readonly buffer First {
    BlockElements first[];
};  // per block: elements of all blocks before it
layout(std430, binding = 8) writeonly buffer Vertices { SurfaceElement vertices[]; };
layout(std430, binding = 9) writeonly buffer Triangles { SurfaceElement triangles[]; };
layout(push_constant) uniform Push { SurfaceParams params; };
#define NEIGHBOUR(i) neighbours[i]
#define INSIDE(i) inside[i]
#include "lib/map/surface_words.glsl"
#include "lib/map/voxel_map.glsl"

void list_vertices(uint block, uint word, uint axis) {
    const EdgeWord edge = edges[block * kBlockEdgeWords + axis * kBlockWords + word];
    uint out_index = first[block].vertices - params.first_vertex + edge.offset;
    for (uint bits = edge.bits; bits != 0u; bits &= bits - 1u) {
        vertices[out_index++] = SurfaceElement(block, axis << 9 | word << 5 | uint(findLSB(bits)));
    }
}

void list_triangles(uint block, uint word) {
    const uvec4 low = CORNERS_AT(INSIDE, block, word, 0);
    const uvec4 high = CORNERS_AT(INSIDE, block, word, 1);
    uint out_index = first[block].triangles - params.first_triangle + triangle_offsets[block * kBlockWords + word];
    uint cells = complete[block * kBlockWords + word] & any_of(low | high) & ~all_of(low & high);
    for (; cells != 0u; cells &= cells - 1u) {
        const uint bit = uint(findLSB(cells));
        const uint which = case_of_cell(low, high, bit);
        const uint count = cases[which * kCaseStride];
        for (uint i = 0u; i < count; ++i) {
            triangles[out_index++] = SurfaceElement(block, i << 17 | which << 9 | word << 5 | bit);
        }
    }
}

void main() {
    const uint item = group_item(gl_WorkGroupID) * kSurfaceGroup + gl_LocalInvocationIndex;
    if (item / kBlockWords >= params.items) return;
    const uint block = batch[item / kBlockWords];
    const uint word = item % kBlockWords;
    [[unroll]] for (uint axis = 0u; axis < 3u; ++axis) list_vertices(block, word, axis);
    list_triangles(block, word);
}
