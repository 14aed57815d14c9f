// Writes into every pixel which component it belongs to, and counts each component's pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/segments/runs.glsl"

layout(local_size_x = kRunGroup) in;
layout(std430, binding = 0) readonly buffer Words { RunWord words[]; };
layout(std430, binding = 1) coherent buffer Parents { uint parents[]; };
layout(std430, binding = 2) buffer Pixels { uint pixels[]; };  // by key; 0 before
layout(binding = 3, r32ui) uniform writeonly uimage2D component;
layout(push_constant) uniform Push { LabelComponentsParams params; };
#include "lib/math/disjoint_sets.glsl"

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.row_words * params.extent.y) return;
    const ivec2 first = ivec2(index % params.row_words * 32u, index / params.row_words);
    const uint first_index = uint(first.y) * params.extent.x + uint(first.x);
    const RunWord word = words[index];
    const uint starts = run_starts(word);
    const int count = min(32, int(params.extent.x) - first.x);
    uint key = 0u;
    for (int i = 0; i < count; ++i) {
        if ((starts >> i & 1u) != 0u) {
            const uint root = find_root(first_index + uint(i));
            atomicMin(parents[first_index + uint(i)], root);  // shortens the way of those who come after
            key = root + 1u;
            atomicAdd(pixels[key], run_length(word, uint(i)));
        }
        imageStore(component, first + ivec2(i, 0), uvec4((word.inside >> i & 1u) != 0u ? key : 0u));
    }
}
