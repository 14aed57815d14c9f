#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Marks the lattice edges that carry a vertex: those that the surface crosses and that a complete cell uses. Counts the
// vertices and triangles of every block, and of its words before each word.
#include "shared/surface/extract_surface.h"
layout(local_size_x = kSurfaceGroup) in;
layout(std430, binding = 0) readonly buffer Neighbours { uint neighbours[]; };
layout(std430, binding = 1) readonly buffer Inside { uint inside[]; };
layout(std430, binding = 2) readonly buffer Complete { uint complete[]; };
layout(std430, binding = 3) readonly buffer Cases { uint cases[]; };
layout(std430, binding = 4) writeonly buffer Edges { EdgeWord edges[]; };
layout(std430, binding = 5) writeonly buffer TriangleOffsets { uint triangle_offsets[]; };
layout(std430, binding = 6) writeonly buffer Counts { BlockElements counts[]; };
layout(push_constant) uniform Push { SurfaceParams params; };
#define NEIGHBOUR(i) neighbours[i]
#define INSIDE(i) inside[i]
#include "lib/map/surface_words.glsl"
#include "lib/map/voxel_map.glsl"

shared uvec4 counts_of_words[kSurfaceGroup];  // edges along x, y, z; triangles

uint complete_at(uint block, uint word, ivec3 offset) { return complete[word_index(block, word, offset)]; }

// Per edge along x, y, z: whether one of the four cells around it is complete.
uvec3 used_edges(uint block, uint word) {
    const uint here = complete_at(block, word, ivec3(0));
    const uint x = complete_at(block, word, ivec3(-1, 0, 0));
    const uint y = complete_at(block, word, ivec3(0, -1, 0));
    const uint z = complete_at(block, word, ivec3(0, 0, -1));
    const uint xy = complete_at(block, word, ivec3(-1, -1, 0));
    const uint yz = complete_at(block, word, ivec3(0, -1, -1));
    const uint xz = complete_at(block, word, ivec3(-1, 0, -1));
    const uint here_or_y = here | last_in_y(here, y);
    return uvec3(here_or_y | z | last_in_y(z, yz),                  //
                 here | last_in_x(here, x) | z | last_in_x(z, xz),  //
                 here_or_y | last_in_x(here_or_y, x | last_in_y(x, xy)));
}

uint count_triangles(uvec4 low, uvec4 high, uint cells) {
    uint triangles = 0u;
    for (; cells != 0u; cells &= cells - 1u) {
        triangles += cases[case_of_cell(low, high, uint(findLSB(cells))) * kCaseStride];
    }
    return triangles;
}

void main() {
    const uint item = group_item(gl_WorkGroupID) * kSurfaceGroup + gl_LocalInvocationIndex;
    const uint block = min(item / kBlockWords, params.items - 1u);
    const uint word = item % kBlockWords;
    const uvec4 low = CORNERS_AT(INSIDE, block, word, 0);
    const uvec4 high = CORNERS_AT(INSIDE, block, word, 1);
    const uint cells = complete[block * kBlockWords + word] & any_of(low | high) & ~all_of(low & high);
    const uvec3 crossed = used_edges(block, word) & (uvec3(low.yz, high.x) ^ low.x);
    const uvec4 own = uvec4(bitCount(crossed), count_triangles(low, high, cells));
    counts_of_words[gl_LocalInvocationIndex] = own;
    barrier();

    const uint first = gl_LocalInvocationIndex - word;
    uvec4 before = uvec4(0u), all = uvec4(0u);
    [[unroll]] for (uint i = 0u; i < kBlockWords; ++i) {
        const uvec4 count = counts_of_words[first + i];
        before += i < word ? count : uvec4(0u);
        all += count;
    }
    if (item / kBlockWords >= params.items) return;
    const uint edge = block * kBlockEdgeWords + word;
    edges[edge] = EdgeWord(crossed.x, before.x);
    edges[edge + kBlockWords] = EdgeWord(crossed.y, all.x + before.y);
    edges[edge + 2u * kBlockWords] = EdgeWord(crossed.z, all.x + all.y + before.z);
    triangle_offsets[item] = before.w;
    if (word == 0u) counts[block] = BlockElements(all.x + all.y + all.z, all.w);
}
