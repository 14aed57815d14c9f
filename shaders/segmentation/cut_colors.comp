#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Adds edges where the chromaticity changes beside a geometric edge: where two things touch, that edge has gaps. And
// takes back creases between parts of one strong colour: they are folds of one thing.
#include "shared/cut_colors.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(binding = 0, r32f) uniform readonly image2D inner_depth_m;  // negative at edges
layout(binding = 1, rgba16f) uniform readonly image2D color_linear;
layout(binding = 2, r32f) uniform writeonly image2D cut_depth_m;
layout(push_constant) uniform Push { CutColorsParams params; };

const float kLeastLight = 0.02;  // sum of the channels; darker pixels have no chromaticity to speak of
const ivec2 kDirections[8] = ivec2[](ivec2(1, 0), ivec2(1, 1), ivec2(0, 1), ivec2(-1, 1), ivec2(-1, 0), ivec2(-1, -1),
                                     ivec2(0, -1), ivec2(1, -1));

// xy: chromaticity; z: 1 where it is known.
vec3 chroma_at(ivec2 pixel) {
    const float z = abs(imageLoad(inner_depth_m, pixel).x);
    const vec2 ray = (vec2(pixel) - params.depth_focal_center_px.zw) / params.depth_focal_center_px.xy;
    const vec3 at = (params.color_from_depth * vec4(ray * z, z, 1.0)).xyz;
    const vec2 place = at.xy / max(at.z, 1e-3) * params.color_focal_center_px.xy + params.color_focal_center_px.zw;
    const vec4 seen = imageLoad(color_linear, ivec2(floor(place + 0.5)));
    const float sum = seen.r + seen.g + seen.b;
    return z > 0.0 && seen.a > 0.0 && sum >= kLeastLight ? vec3(seen.rg / sum, 1.0) : vec3(0.0);
}

bool differ(ivec2 pixel, ivec2 offset) {
    const vec3 a = chroma_at(pixel - offset), b = chroma_at(pixel + offset);
    const vec2 apart = abs(a.xy - b.xy);
    return a.z * b.z > 0.0 && max(apart.x, apart.y) > params.chroma;
}

bool agree(ivec2 pixel, ivec2 offset) {
    const vec3 a = chroma_at(pixel - offset), b = chroma_at(pixel + offset);
    const vec2 apart = abs(a.xy - b.xy);
    const vec2 from_grey = abs(0.5 * (a.xy + b.xy) - 1.0 / 3.0);
    return a.z * b.z > 0.0 && max(apart.x, apart.y) <= params.same_chroma &&
           max(from_grey.x, from_grey.y) > params.strong_chroma;
}

bool is_near_edge(ivec2 pixel) {
    bool near = false;
    [[unroll]] for (int i = 0; i < 8; ++i) {
        // Outside the image loads are zero.
        near = near || imageLoad(inner_depth_m, pixel + kDirections[i] * params.reach_px).x < 0.0 ||
               imageLoad(inner_depth_m, pixel + kDirections[i] * (params.reach_px / 2)).x < 0.0;
    }
    return near;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    const float here = imageLoad(inner_depth_m, pixel).x;
    bool edge = false;
    if (here > 0.0 && is_near_edge(pixel)) edge = differ(pixel, ivec2(2, 0)) || differ(pixel, ivec2(0, 2));
    if (here < 0.0) edge = !(agree(pixel, ivec2(3, 0)) && agree(pixel, ivec2(0, 3)));
    imageStore(cut_depth_m, pixel, vec4(edge ? -abs(here) : abs(here)));
}
