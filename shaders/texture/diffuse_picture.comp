#version 460
#extension GL_GOOGLE_include_directive : require
// What leaves diffusely from what a picture shows, its colour less the highlight, and the light there: the two terms of
// the albedo (paper, Eq. 7). One invocation per pixel.
#include "shared/input/convert_color.h"
#include "shared/texture/texture.h"
#include "texture/albedo_states.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba16f) uniform readonly image2D color;
layout(binding = 1, r32f) uniform readonly image2D depth_m;  // cast, of any extent; 0: nothing was hit
layout(binding = 2, rgba16f) uniform readonly image2D kd;
layout(binding = 3, rgba16f) uniform readonly image2D rgb;
layout(binding = 4, rgba16f) uniform readonly image2D light;
layout(binding = 5, rgba16f) uniform writeonly image2D diffuse;
layout(binding = 6, rgba16f) uniform writeonly image2D shine;
layout(push_constant) uniform Push { DiffusePictureParams params; };

const float kOffVox = 3.0;  // along the view: farther from the surface of the nearest cast pixel is another one
const int kEdge_px = 2;
const float kBentVox = 3.0;     // along the view
const float kClipped = 0.99;    // from here on a channel of a clipped pixel is at least as bright
const float kLeastClear = 0.5;  // of what is seen is diffuse; below, the highlight's error is as large as the albedo

// Whether the surface ends near a pixel of the cast image: there a picture's pixels may show what is behind. Between
// two pixels on opposite sides a plane's inverse depth lies in the middle.
bool at_edge(ivec2 pixel, float own_m) {
    for (int i = 0; i < 4; ++i) {
        const ivec2 step = kEdge_px * ivec2(i == 1 ? 0 : 1, i == 3 ? -1 : min(i, 1));
        const float one_m = imageLoad(depth_m, pixel + step).r, other_m = imageLoad(depth_m, pixel - step).r;
        if (one_m <= 0.0 || other_m <= 0.0) return true;
        const float bent_m = abs(1.0 / one_m + 1.0 / other_m - 2.0 / own_m) * own_m * own_m;
        if (bent_m > kBentVox * params.voxel_m) return true;
    }
    return false;
}

struct Told {
    vec4 diffuse;  // a: what it is worth
    vec3 light;
};

Told told_at(ivec2 pixel) {
    const Told nothing = Told(vec4(0.0, 0.0, 0.0, kColorInvalid), vec3(0.0));
    const vec4 seen = imageLoad(color, pixel);
    const vec2 cast_at = (vec2(pixel) + 0.5) * vec2(imageSize(depth_m)) / vec2(imageSize(color)) - 0.5;
    const float own_m = imageLoad(depth_m, ivec2(floor(cast_at + 0.5))).r;
    if (seen.a == kColorInvalid || own_m <= 0.0) return nothing;
    const ivec2 low = ivec2(floor(cast_at));
    const vec2 t = cast_at - vec2(low);
    vec3 arriving = vec3(0.0), highlight = vec3(0.0), modelled = vec3(0.0);
    float shares = 0.0;
    for (int i = 0; i < 4; ++i) {
        const ivec2 step = ivec2(i & 1, i >> 1), at = low + step;
        const vec2 weights = mix(1.0 - t, t, vec2(step));
        const float share = weights.x * weights.y, there_m = imageLoad(depth_m, at).r;  // 0 outside the image
        if (share == 0.0 || there_m <= 0.0 || abs(there_m - own_m) > kOffVox * params.voxel_m) continue;
        const vec4 known = imageLoad(kd, at);
        const vec3 arrives = imageLoad(light, at).rgb, leaves = imageLoad(rgb, at).rgb;
        arriving += share * arrives;
        modelled += share * leaves;
        if (known.a > 0.0) highlight += share * max(leaves - known.rgb * arrives, 0.0);
        shares += share;
    }
    if (shares == 0.0) return nothing;
    arriving /= shares;
    highlight /= shares;
    modelled /= shares;
    vec3 leaving = seen.rgb / params.gain.rgb;
    if (seen.a == kColorClipped)
        leaving = mix(leaving, max(leaving, modelled), greaterThanEqual(seen.rgb, vec3(kClipped)));
    // Below 0 where the model's highlight is too bright: in a view from about here it is likewise, which cancels out.
    const vec3 leaves = clamp(leaving - highlight, -1e4, 1e4);
    const float clear = dot(leaves, vec3(1.0)) / max(dot(leaving, vec3(1.0)), 1e-6);
    const bool tells = seen.a == kColorValid && all(greaterThanEqual(arriving, vec3(kLeastShownLight))) &&
                       all(lessThanEqual(leaves, kMostAlbedo * arriving)) && clear >= kLeastClear;
    if (at_edge(ivec2(floor(cast_at + 0.5)), own_m)) return Told(vec4(leaves, kColorAtEdge), arriving);
    return Told(tells ? vec4(max(leaves, 0.0), kColorValid) : vec4(leaves, kColorClipped), arriving);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(diffuse)))) return;
    const Told told = told_at(pixel);
    imageStore(diffuse, pixel, told.diffuse);
    imageStore(shine, pixel, vec4(told.light, 0.0));
}
