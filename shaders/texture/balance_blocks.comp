#version 460
#extension GL_GOOGLE_include_directive : require
// How much brighter the records take the surface around a block to be than the pictures do, by channel. One invocation
// per block of a page.
#include "shared/texture/texture.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Blocks { TextureBlock blocks[]; };
layout(std430, binding = 1) writeonly buffer Balance { vec4 balance[]; };  // rgb: factor; a: 1 where it is known
layout(push_constant) uniform Push { BalanceBlocksParams params; };

const int kTaps = int(kBalanceTaps);
const float kDarkest = 0.01;  // added to both means: what is black says nothing of a factor

void main() {
    const uvec2 block = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(block, params.blocks))) return;
    const uint own = block.y * params.blocks.x + block.x;
    const TextureBlock here = blocks[own];
    if (here.position_m.w == 0.0) {
        balance[own] = vec4(1.0, 1.0, 1.0, 0.0);
        return;
    }
    vec3 seen = vec3(0.0), known = vec3(0.0);
    float shares = 0.0;
    for (int y = -kTaps; y <= kTaps; ++y) {
        for (int x = -kTaps; x <= kTaps; ++x) {
            const ivec2 at = ivec2(block) + ivec2(x, y) * int(params.stride);
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(params.blocks)))) continue;
            const TextureBlock there = blocks[uint(at.y) * params.blocks.x + uint(at.x)];
            const float away_m = distance(there.position_m.xyz, here.position_m.xyz);
            if (there.position_m.w == 0.0 || away_m > params.reach_m) continue;
            const float share = there.position_m.w * exp(-2.0 * away_m * away_m / (params.reach_m * params.reach_m));
            seen += share * there.seen.rgb;
            known += share * there.known.rgb;
            shares += share;
        }
    }
    const vec3 factor = (known / shares + kDarkest) / (seen / shares + kDarkest);
    balance[own] = vec4(clamp(factor, 1.0 / params.most_factor, params.most_factor), 1.0);
}
