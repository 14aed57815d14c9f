// Unites runs that are connected to the word on the left or to the row above.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/segments/runs.glsl"

layout(local_size_x = kRunGroup) in;
layout(std430, binding = 0) readonly buffer Words { RunWord words[]; };
layout(std430, binding = 1) coherent buffer Parents { uint parents[]; };
layout(push_constant) uniform Push { LabelComponentsParams params; };
#include "lib/math/disjoint_sets.glsl"

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.row_words * params.extent.y) return;
    const uint row = index / params.row_words;
    const uint first = row * params.extent.x + index % params.row_words * 32u;
    const RunWord word = words[index];
    if ((word.left & 1u) != 0u) unite(first, first - 32u + run_start(words[index - 1u].left, 31u));
    if (word.up == 0u) return;
    const uint above = words[index - params.row_words].left;
    // A connection upwards follows from that of the pixel on the left where both rows are connected (Playne and
    // Hawick).
    for (uint bits = word.up & ~(word.left & above & word.up << 1); bits != 0u; bits &= bits - 1u) {
        const uint bit = uint(findLSB(bits));
        unite(first + run_start(word.left, bit), first - params.extent.x + run_start(above, bit));
    }
}
