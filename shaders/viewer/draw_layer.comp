#version 460
#extension GL_GOOGLE_include_directive : require
// A layer of a view as a picture.
#include "shared/viewer/draw_layer.h"
layout(local_size_x = kDrawLayerGroup, local_size_y = kDrawLayerGroup) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(binding = 2, rgba16f) uniform readonly image2D value;
layout(binding = 3, rgba8) uniform writeonly image2D picture;
layout(push_constant) uniform Push { DrawLayerParams params; };
#include "viewer/draw_layer_main.glsl"

// From dark blue over green to yellow: as bright as the value is high, also in grey.
const vec3 kScale[5] = vec3[](vec3(0.267, 0.005, 0.329), vec3(0.230, 0.322, 0.546), vec3(0.128, 0.567, 0.551),
                              vec3(0.369, 0.789, 0.383), vec3(0.993, 0.906, 0.144));

vec3 scale_color(float at) {
    const float along = clamp(at, 0.0, 1.0) * 4.0;
    const int below = min(int(along), 3);
    return mix(kScale[below], kScale[below + 1], along - float(below));
}

// What is brighter than the shoulder comes near 1, and never there.
float compressed(float x) {
    const float room = 1.0 - params.shoulder;
    if (x <= params.shoulder || room <= 0.0) return min(x, 1.0);
    return params.shoulder + room * (1.0 - exp(-(x - params.shoulder) / room));
}

float srgb(float x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055; }

vec3 exposed(vec3 linear) {
    const vec3 x = max(linear * params.exposure, vec3(0.0));
    return vec3(srgb(compressed(x.r)), srgb(compressed(x.g)), srgb(compressed(x.b)));
}

vec3 encoded(vec3 direction, vec4 found) {
    if (params.style == kDrawNormal) return direction == vec3(0.0) ? kNoValue : direction * 0.5 + 0.5;
    if (found.a <= 0.0) return kNoValue;
    if (params.style == kDrawColor) return exposed(found.rgb);
    return scale_color((found[params.channel] - params.low) / (params.high - params.low));
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(picture)))) return;
    const vec3 direction = imageLoad(normal, pixel).xyz;
    draw(pixel, imageLoad(position_m, pixel), direction, encoded(direction, imageLoad(value, pixel)));
}
