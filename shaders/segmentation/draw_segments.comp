// Writes the number of its component into every pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/runs.glsl"
#include "shared/draw_segments.h"

layout(local_size_x = kRunGroup) in;
layout(std430, binding = 0) readonly buffer Words { RunWord words[]; };
layout(std430, binding = 1) readonly buffer Parents { uint parents[]; };
layout(std430, binding = 2) readonly buffer Pixels { uint pixels[]; };
layout(std430, binding = 3) readonly buffer Numbers { uint numbers[]; };
layout(binding = 4, r32ui) uniform writeonly uimage2D segment;
layout(push_constant) uniform Push { DrawSegmentsParams params; };

uint number_of(uint start) {
    const uint root = parents[start];
    return pixels[root] < params.min_pixels ? 0u : numbers[root];
}

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.row_words * params.extent.y) return;
    const ivec2 first = ivec2(index % params.row_words * 32u, index / params.row_words);
    const uint first_index = uint(first.y) * params.extent.x + uint(first.x);
    const RunWord word = words[index];
    const uint starts = run_starts(word);
    const int count = min(32, int(params.extent.x) - first.x);
    uint number = 0u;
    for (int i = 0; i < count; ++i) {
        if ((starts >> i & 1u) != 0u) number = number_of(first_index + uint(i));
        imageStore(segment, first + ivec2(i, 0), uvec4((word.inside >> i & 1u) != 0u ? number : 0u));
    }
}
