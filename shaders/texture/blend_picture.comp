#version 460
#extension GL_GOOGLE_include_directive : require
// Adds what one picture says of each texel that it truly sees: its colour, less the highlight, over the light there.
// The weight falls with the angle and the square of the distance, and towards the picture's border. Between a picture's
// pixels colours are blurred: what lies in the middle of one counts most, so that together pictures show what is finer
// than their pixels. One invocation per texel.
#include "lib/math/octahedral.glsl"
#include "shared/input/convert_color.h"
#include "shared/texture/texture.h"
#include "texture/albedo_states.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 0) const bool kReflects = true;  // the model says how much light there is; else colours are taken
layout(std430, binding = 0) readonly buffer Texels { SurfaceTexel texels[]; };
layout(std430, binding = 1) buffer Sums { vec4 sums[]; };  // rgb: weighted sum of albedo; a: of weights
layout(binding = 2, rgba16f) uniform readonly image2D color;
layout(binding = 3, r32f) uniform readonly image2D depth_m;  // cast; 0: nothing was hit
layout(binding = 4, rgba16f) uniform readonly image2D kd;
layout(binding = 5, rgba16f) uniform readonly image2D rgb;
layout(binding = 6, rgba16f) uniform readonly image2D light;
layout(push_constant) uniform Push { BlendPictureParams params; };
#include "texture/sight.glsl"

const float kCentred = 32.0;
const float kLeastCentred = 0.05;  // halfway between pixels

struct Corner {
    vec3 light, highlight;
};

// What the model says at a pixel of the cast images.
Corner corner_at(ivec2 pixel) {
    if (!kReflects) return Corner(vec3(1.0), vec3(0.0));
    const vec3 shine = imageLoad(light, pixel).rgb;
    const vec4 albedo = imageLoad(kd, pixel);
    const vec3 highlight = albedo.a > 0.0 ? max(imageLoad(rgb, pixel).rgb - albedo.rgb * shine, 0.0) : vec3(0.0);
    return Corner(shine, highlight);
}

// The picture's colour between four pixels; a: 0 where one of them says nothing.
vec4 color_at(vec2 at) {
    const ivec2 low = ivec2(floor(at));
    const vec2 t = at - vec2(low);
    const vec4 c00 = imageLoad(color, low), c10 = imageLoad(color, low + ivec2(1, 0));
    const vec4 c01 = imageLoad(color, low + ivec2(0, 1)), c11 = imageLoad(color, low + ivec2(1, 1));
    if (min(min(c00.a, c10.a), min(c01.a, c11.a)) < kColorValid) return vec4(0.0);
    return vec4(mix(mix(c00.rgb, c10.rgb, t.x), mix(c01.rgb, c11.rgb, t.x), t.y), 1.0);
}

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.texels) return;
    const SurfaceTexel texel = texels[index];
    if (texel.normal == kNoSurface) return;
    const vec3 world_m = uintBitsToFloat(uvec3(texel.x, texel.y, texel.z));
    const vec3 normal = from_octahedral(unpackSnorm2x16(texel.normal));
    const Sight sight = sight_of(params.camera, world_m, normal, params.gain_voxel_m.w);
    if (!sight.within) return;
    vec3 shine = vec3(0.0), highlight = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        const ivec2 step = ivec2(i & 1, i >> 1);
        if (!shows_it(sight, sight.low + step)) return;
        const Corner corner = corner_at(sight.low + step);
        const vec2 share = mix(1.0 - sight.between, sight.between, vec2(step));
        shine += share.x * share.y * corner.light;
        highlight += share.x * share.y * corner.highlight;
    }
    const vec4 seen = color_at(sight.at);
    if (seen.a == 0.0 || any(lessThan(shine, vec3(kLeastShownLight)))) return;
    const vec3 diffuse = max(seen.rgb / params.gain_voxel_m.rgb - highlight, 0.0);
    const vec3 albedo = diffuse / shine;
    if (any(greaterThan(albedo, vec3(kMostAlbedo)))) return;

    const float clear = dot(diffuse, vec3(1.0)) / max(dot(diffuse + highlight, vec3(1.0)), 1e-6);
    const float facing = sight.cosine / (sight.range_m * sight.range_m);
    const vec2 beside = sight.at - round(sight.at);
    const float centred = max(exp(-kCentred * dot(beside, beside)), kLeastCentred);
    const float weight = pow(facing, kSharpness) * sight.fade * max(clear * clear, 1e-3) * centred;
    sums[index] += vec4(weight * albedo, weight);
}
