#version 460
#extension GL_GOOGLE_include_directive : require
// The segments of a view as a picture: each has a colour of its own.
#include "shared/viewer/draw_layer.h"
layout(local_size_x = kDrawLayerGroup, local_size_y = kDrawLayerGroup) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(binding = 2, r32ui) uniform readonly uimage2D label;
layout(binding = 3, rgba8) uniform writeonly image2D picture;
layout(push_constant) uniform Push { DrawLayerParams params; };
#include "viewer/draw_layer_main.glsl"

// Steps of the golden ratio spread any number of hues evenly; three lightnesses tell neighbouring hues apart.
vec3 label_color(uint number) {
    const float turn = float(number * 2654435769u) * (1.0 / 4294967296.0);
    const float lightness = 0.55 + 0.15 * float(number % 3u);
    const vec3 wave = 0.5 + 0.5 * cos(6.28318530718 * (turn - vec3(0.0, 1.0, 2.0) / 3.0));
    return lightness * (0.25 + 0.75 * wave);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(picture)))) return;
    const uint number = imageLoad(label, pixel).r;
    draw(pixel, imageLoad(position_m, pixel), imageLoad(normal, pixel).xyz,
         number == 0u ? kNoValue : label_color(number));
}
