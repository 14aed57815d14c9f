#version 460
#extension GL_GOOGLE_include_directive : require
// Packs the albedo of each texel: the mean of what pictures say, balanced between the blocks around; where none shows
// it what the records know. One invocation per texel.
#include "lib/color/packed_albedo.glsl"
#include "shared/texture/texture.h"

layout(local_size_x = 16, local_size_y = 4) in;
layout(std430, binding = 0) readonly buffer Texels { SurfaceTexel texels[]; };
layout(std430, binding = 1) readonly buffer Sums { vec4 sums[]; };
layout(std430, binding = 2) readonly buffer Known { uint known[]; };
layout(std430, binding = 3) readonly buffer Blocks { TextureBlock blocks[]; };
layout(std430, binding = 4) readonly buffer Balance { vec4 balance[]; };
layout(std430, binding = 5) writeonly buffer Albedo {
    uint albedo[];
};  // pack_albedo; state: 0 empty, 1 filled, 2 seen
layout(push_constant) uniform Push { FinishTexelsParams params; };

const float kFillReach_m = 0.03;

// What the blocks around a place of the page agree on; a: 0 where none is of this surface.
struct Around {
    vec4 factor;  // rgb: of pictures
    vec4 albedo;  // rgb: by pictures, balanced; of blocks nearer than kFillReach_m
};

Around around_of(vec2 place, vec3 position_m) {
    const vec2 at = place / float(kTextureBlock) - 0.5;
    const ivec2 low = ivec2(floor(at));
    const vec2 t = at - vec2(low);
    Around sums = Around(vec4(0.0), vec4(0.0));
    for (int i = 0; i < 4; ++i) {
        const ivec2 step = ivec2(i & 1, i >> 1);
        const ivec2 block = clamp(low + step, ivec2(0), ivec2(params.blocks_x, params.blocks_y) - 1);
        const uint index = uint(block.y) * params.blocks_x + uint(block.x);
        const vec2 shares = mix(1.0 - t, t, vec2(step));
        const float share = shares.x * shares.y + 1e-4, away_m = distance(blocks[index].position_m.xyz, position_m);
        if (balance[index].a == 0.0 || away_m > params.reach_m) continue;
        sums.factor += share * balance[index];
        if (away_m <= kFillReach_m) sums.albedo += share * vec4(balance[index].rgb * blocks[index].seen.rgb, 1.0);
    }
    if (sums.factor.a > 0.0) sums.factor /= sums.factor.a;
    if (sums.albedo.a > 0.0) sums.albedo /= sums.albedo.a;
    return sums;
}

void main() {
    const uvec2 texel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(texel, params.extent))) return;
    const uint index = texel.y * params.extent.x + texel.x;
    const SurfaceTexel own = texels[index];
    if (own.normal == kNoSurface) {
        albedo[index] = 0u;
        return;
    }
    const vec4 sum = sums[index];
    const vec3 by_records = unpack_albedo(known[index]);
    const vec3 position_m = uintBitsToFloat(uvec3(own.x, own.y, own.z));
    const Around around = around_of(vec2(texel) + vec2(0.5, float(params.first_row) + 0.5), position_m);
    if (sum.a <= 0.0) {
        albedo[index] = pack_albedo(around.albedo.a > 0.0 ? around.albedo.rgb : by_records, 1u);
    } else {
        albedo[index] = pack_albedo(around.factor.a > 0.0 ? around.factor.rgb * sum.rgb / sum.a : by_records, 2u);
    }
}
