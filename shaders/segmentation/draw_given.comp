// Writes the number of its given id into every pixel that has depth.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/draw_segments.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(binding = 0, r32ui) uniform readonly uimage2D given;     // 0: unknown
layout(binding = 1, rgba32f) uniform readonly image2D surface;  // w: depth
layout(std430, binding = 2) readonly buffer Numbers { uint numbers[]; };
layout(binding = 3, r32ui) uniform writeonly uimage2D segment;
layout(push_constant) uniform Push { CountGivenParams params; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    const uint id = imageLoad(given, pixel).x;
    const bool known = id != 0u && id < params.ids && imageLoad(surface, pixel).w > 0.0;
    imageStore(segment, pixel, uvec4(known ? numbers[known ? id : 0u] : 0u));
}
