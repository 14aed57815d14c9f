#version 460
#extension GL_GOOGLE_include_directive : require
// Adds what one picture without its highlights shows of each texel that an eye looks at: what leaves it, and over the
// light there the albedo. One invocation per texel.
#include "lib/math/octahedral.glsl"
#include "shared/input/convert_color.h"
#include "shared/texture/texture.h"
#include "texture/albedo_states.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Texels { SurfaceTexel texels[]; };
layout(std430, binding = 1) buffer Sums { vec4 sums[]; };    // rgb: weighted sum of albedo; a: of weights
layout(std430, binding = 2) buffer Shown { vec4 shown[]; };  // rgb: of what leaves, also where it tells no albedo
layout(binding = 3, rgba16f) uniform readonly image2D diffuse;
layout(binding = 4, rgba16f) uniform readonly image2D light;
layout(binding = 5, r32f) uniform readonly image2D depth_m;  // cast; 0: nothing was hit
layout(push_constant) uniform Push { BlendDiffuseParams params; };
#include "texture/sight.glsl"

const float kNear_rad = 0.02;  // about 1 degree: between views that err alike
const float kAside = 2.0;      // over kNear_rad: from beyond, what is seen beside edges may be another surface

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.texels) return;
    const SurfaceTexel texel = texels[index];
    if (texel.normal == kNoSurface) return;
    const vec3 world_m = uintBitsToFloat(uvec3(texel.x, texel.y, texel.z));
    const vec3 normal = from_octahedral(unpackSnorm2x16(texel.normal));
    const Sight sight = sight_of(params.camera, world_m, normal, params.voxel_m);
    if (!sight.within) return;
    for (int i = 0; i < 4; ++i)
        if (!shows_it(sight, sight.low + ivec2(i & 1, i >> 1))) return;

    const ivec2 low = ivec2(floor(sight.at));
    const vec2 t = sight.at - vec2(low);
    vec3 leaves = vec3(0.0), albedo = vec3(0.0);
    float worst = kColorValid;
    for (int i = 0; i < 4; ++i) {
        const ivec2 step = ivec2(i & 1, i >> 1);
        const vec4 here = imageLoad(diffuse, low + step);
        const vec2 shares = mix(1.0 - t, t, vec2(step));
        worst = min(worst, here.a);
        leaves += shares.x * shares.y * here.rgb;
        albedo += shares.x * shares.y * here.rgb / max(imageLoad(light, low + step).rgb, vec3(kLeastShownLight));
    }
    if (worst == kColorInvalid) return;

    // Who looks sees no more than from there. Pictures from that direction err least: what is wrong with poses, with
    // the surface and with highlights shifts them alike.
    const vec3 to_eye_m = vec3(params.eye_x_m, params.eye_y_m, params.eye_z_m) - world_m;
    const float away_m = length(to_eye_m);
    const vec3 to_eye = to_eye_m / away_m;
    const float facing =
        min(sight.cosine / (sight.range_m * sight.range_m), max(dot(normal, to_eye), kLeastCosine) / (away_m * away_m));
    const float between = length(to_eye - sight.to_picture) / kNear_rad;
    if (worst == kColorAtEdge && between > kAside) return;
    const float weight = pow(facing, kSharpness) * sight.fade / pow(1.0 + between * between, 2.0);
    if (worst == kColorValid) sums[index] += vec4(weight * albedo, weight);
    shown[index] += vec4(weight * leaves, weight);
}
