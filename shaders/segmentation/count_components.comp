// Points every run to its component's root, the component's first pixel, and counts the pixels there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/runs.glsl"

layout(local_size_x = kRunGroup) in;
layout(std430, binding = 0) readonly buffer Words { RunWord words[]; };
layout(std430, binding = 1) coherent buffer Parents { uint parents[]; };
layout(std430, binding = 2) buffer Pixels { uint pixels[]; };  // by key; 0 before
layout(push_constant) uniform Push { LabelComponentsParams params; };
#include "lib/disjoint_sets.glsl"

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.row_words * params.extent.y) return;
    const uint first = index / params.row_words * params.extent.x + index % params.row_words * 32u;
    const RunWord word = words[index];
    for (uint starts = run_starts(word); starts != 0u; starts &= starts - 1u) {
        const uint bit = uint(findLSB(starts));
        const uint root = find_root(first + bit);
        atomicMin(parents[first + bit], root);
        atomicAdd(pixels[root], run_length(word, bit));
    }
}
