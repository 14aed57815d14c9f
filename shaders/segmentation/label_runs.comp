// Finds the runs of 32 pixels of a row; each is a set of its own.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/segments/runs.glsl"

layout(local_size_x = kRunGroup) in;
layout(binding = 0, r32f) uniform readonly image2D inner_depth_m;  // above 0 where a pixel belongs to a component
layout(std430, binding = 1) writeonly buffer Words { RunWord words[]; };
layout(std430, binding = 2) writeonly buffer Parents { uint parents[]; };
layout(push_constant) uniform Push { LabelComponentsParams params; };

// 0 outside the picture.
float load(ivec2 pixel) {
    const bool inside = all(greaterThanEqual(pixel, ivec2(0))) && pixel.x < int(params.extent.x);
    return inside ? imageLoad(inner_depth_m, pixel).x : 0.0;
}

bool connected(float a, float b) {
    return a > 0.0 && b > 0.0 && abs(a - b) <= params.jump_m + params.jump_slope * max(a, b);
}

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.row_words * params.extent.y) return;
    const ivec2 first = ivec2(index % params.row_words * 32u, index / params.row_words);
    RunWord word = RunWord(0u, 0u, 0u);
    float before = load(first - ivec2(1, 0));
    for (int i = 0; i < 32; ++i) {
        const float here = load(first + ivec2(i, 0));
        const float above = load(first + ivec2(i, -1));
        word.inside |= uint(here > 0.0) << i;
        word.left |= uint(connected(here, before)) << i;
        word.up |= uint(connected(here, above)) << i;
        before = here;
    }
    words[index] = word;
    const uint first_index = uint(first.y) * params.extent.x + uint(first.x);
    for (uint starts = run_starts(word); starts != 0u; starts &= starts - 1u) {
        const uint start = first_index + uint(findLSB(starts));
        parents[start] = start;
    }
}
