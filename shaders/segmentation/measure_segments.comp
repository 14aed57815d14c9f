// Writes into every pixel the number of its segment, and counts the pixels of each, 32 of a row at a time.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/segmentation/number_segments.h"

layout(local_size_x = kMeasureGroup) in;
layout(binding = 0, r32ui) uniform readonly uimage2D keys;  // 0: none
layout(binding = 1, r32f) uniform readonly image2D depth_m;
layout(std430, binding = 2) readonly buffer Pixels { uint pixels[]; };    // by key
layout(std430, binding = 3) readonly buffer Numbers { uint numbers[]; };  // by key; only where enough pixels are
layout(std430, binding = 4) buffer Segments { FrameSegment segments[]; };
layout(binding = 5, r32ui) uniform writeonly uimage2D segment;
layout(push_constant) uniform Push { MeasureSegmentsParams params; };

void add(uint number, uint count, uint first_x, uint y) {
    if (number == 0u) return;
    const uvec2 last = params.extent - 1u;
    const bool at_border = first_x == 0u || first_x + count - 1u == last.x || y == 0u || y == last.y;
    atomicAdd(segments[number].pixels, count * params.area);
    if (at_border) segments[number].touches_border = 1u;
}

uint number_of(uint key) {
    if (key >= params.keys) return 0u;
    uint count = pixels[key];
    if (count >= kForwardedKey) {
        key = count & ~kForwardedKey;
        count = pixels[key];
    }
    return count >= params.min_pixels ? numbers[key] : 0u;
}

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.row_words * params.extent.y) return;
    const ivec2 first = ivec2(index % params.row_words * 32u, index / params.row_words);
    const int count = min(32, int(params.extent.x) - first.x);
    uint key = 0u, number_of_key = 0u, run = 0u, run_number = 0u;
    for (int i = 0; i < count; ++i) {
        const ivec2 pixel = first + ivec2(i, 0);
        const uint here = imageLoad(keys, pixel).x;
        if (here != key) {
            key = here;
            number_of_key = number_of(here);
        }
        const uint number = imageLoad(depth_m, pixel).x > 0.0 ? number_of_key : 0u;
        imageStore(segment, pixel, uvec4(number));
        if (number != run_number) {
            add(run_number, run, uint(pixel.x) - run, uint(first.y));
            run_number = number;
            run = 0u;
        }
        ++run;
    }
    add(run_number, run, uint(first.x + count) - run, uint(first.y));
}
