#version 460
#extension GL_GOOGLE_include_directive : require
// What pictures tell of each pixel of a view: means of sums. Albedo is balanced between the blocks around. One
// invocation per pixel.
#include "lib/math/octahedral.glsl"
#include "shared/texture/texture.h"

layout(local_size_x = 8, local_size_y = 8) in;
// With what records know: the albedo, elsewhere as it was. Else what pictures show, and 0 where none does.
layout(constant_id = 0) const bool kBalanced = false;
layout(std430, binding = 0) readonly buffer Texels { SurfaceTexel texels[]; };
layout(std430, binding = 1) readonly buffer Sums { vec4 sums[]; };
layout(std430, binding = 2) readonly buffer Blocks { TextureBlock blocks[]; };
layout(std430, binding = 3) readonly buffer Balance { vec4 balance[]; };
layout(binding = 4, rgba16f) uniform readonly image2D elsewhere;
layout(binding = 5, rgba16f) uniform writeonly image2D pixels;  // a: 1 where a picture shows the surface
layout(push_constant) uniform Push { ViewTexelsParams params; };
#include "texture/around.glsl"

const int kFill_px = 3;        // along both axes, as far as a pixel that no picture shows looks for one
const float kFillSlope = 0.5;  // how far out of the tangent plane, over how far away

vec3 position_of(SurfaceTexel texel) { return uintBitsToFloat(uvec3(texel.x, texel.y, texel.z)); }

// What pictures say of the surface at a pixel: they miss its rim, where their pixels see two surfaces, so that there
// what they say beside it counts. a: 0 where there is nothing.
vec4 seen_at(ivec2 pixel, ivec2 extent, SurfaceTexel own, vec4 sum) {
    if (sum.a > 0.0) return vec4(sum.rgb / sum.a, 1.0);
    const vec3 position_m = position_of(own), facing = from_octahedral(unpackSnorm2x16(own.normal));
    vec4 filled = vec4(0.0);
    for (int y = -kFill_px; y <= kFill_px; ++y) {
        for (int x = -kFill_px; x <= kFill_px; ++x) {
            const ivec2 at = pixel + ivec2(x, y);
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, extent))) continue;
            const int index = at.y * extent.x + at.x;
            const vec4 there = sums[index];
            if (there.a <= 0.0) continue;
            const vec3 away_m = position_of(texels[index]) - position_m;
            const float distance_m = length(away_m);
            if (distance_m > kFillReach_m || abs(dot(away_m, facing)) > kFillSlope * distance_m) continue;
            filled += exp(-0.5 * float(x * x + y * y)) * vec4(there.rgb / there.a, 1.0);
        }
    }
    return filled.a > 0.0 ? vec4(filled.rgb / filled.a, 1.0) : vec4(0.0);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), extent = imageSize(pixels);
    if (any(greaterThanEqual(pixel, extent))) return;
    const int index = pixel.y * extent.x + pixel.x;
    const SurfaceTexel own = texels[index];
    vec4 shown = kBalanced ? imageLoad(elsewhere, pixel) : vec4(0.0);
    if (own.normal != kNoSurface) {
        const vec4 seen = seen_at(pixel, extent, own, sums[index]);
        if (!kBalanced) {
            shown = seen;
        } else if (seen.a > 0.0) {
            const Around around = around_of(vec2(pixel) + 0.5, position_of(own), ivec2(params.blocks), params.reach_m);
            if (around.factor.a > 0.0) shown = vec4(min(around.factor.rgb * seen.rgb, vec3(1.0)), 1.0);
        }
    }
    imageStore(pixels, pixel, shown);
}
