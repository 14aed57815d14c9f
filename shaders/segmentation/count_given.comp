// Counts the pixels with depth of each given id.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/segmentation/number_segments.h"

layout(local_size_x = kMeasureGroup) in;
layout(binding = 0, r32ui) uniform readonly uimage2D given;  // 0: unknown
layout(binding = 1, r32f) uniform readonly image2D depth_m;
layout(std430, binding = 2) buffer Pixels { uint pixels[]; };  // by id; 0 before
layout(push_constant) uniform Push { CountGivenParams params; };

void add(uint id, uint count) {
    if (count > 0u) atomicAdd(pixels[id], count);
}

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.row_words * params.extent.y) return;
    const ivec2 first = ivec2(index % params.row_words * 32u, index / params.row_words);
    const int count = min(32, int(params.extent.x) - first.x);
    uint id = 0u, run = 0u;
    for (int i = 0; i < count; ++i) {
        const ivec2 pixel = first + ivec2(i, 0);
        const uint here = imageLoad(given, pixel).x;
        if (here != id) {
            add(id, run);
            id = here;
            run = 0u;
        }
        run += uint(id != 0u && id < params.keys && imageLoad(depth_m, pixel).x > 0.0);
    }
    add(id, run);
}
