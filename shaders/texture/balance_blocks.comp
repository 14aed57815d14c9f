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
const float kNoise2 = 1.0;    // one standard deviation, squared

// What is left of a factor, by channel, beside what print makes of it by chance. A record shows one point of the
// surface, here a stroke and there paper. A mean over `records` of them is off by that, as pictures tell: `squares` is
// the mean of their albedo squared. James and Stein 1961, for one quantity: a factor within the noise becomes 1, one
// far beyond it stays.
vec3 beyond_chance(vec3 factor, vec3 seen, vec3 squares, float records) {
    const vec3 floored = seen + kDarkest;
    const vec3 noise2 = max(squares - seen * seen, 0.0) / (floored * floored * records);
    const vec3 off = log(factor);
    const vec3 share = max(1.0 - kNoise2 * noise2 / max(off * off, 1e-12), 0.0);
    return exp(share * off);
}

void main() {
    const uvec2 block = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(block, params.blocks))) return;
    const uint own = block.y * params.blocks.x + block.x;
    const TextureBlock here = blocks[own];
    if (here.position_m.w == 0.0) {
        balance[own] = vec4(1.0, 1.0, 1.0, 0.0);
        return;
    }
    vec3 seen = vec3(0.0), squares = vec3(0.0), known = vec3(0.0);
    float shares = 0.0, shares2 = 0.0;
    for (int y = -kTaps; y <= kTaps; ++y) {
        for (int x = -kTaps; x <= kTaps; ++x) {
            const ivec2 at = ivec2(block) + ivec2(x, y) * int(params.stride);
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(params.blocks)))) continue;
            const TextureBlock there = blocks[uint(at.y) * params.blocks.x + uint(at.x)];
            const float away_m = distance(there.position_m.xyz, here.position_m.xyz);
            if (there.position_m.w == 0.0 || away_m > params.reach_m) continue;
            const float share = there.position_m.w * exp(-2.0 * away_m * away_m / (params.reach_m * params.reach_m));
            seen += share * there.seen.rgb;
            squares += share * there.squares.rgb;
            known += share * there.known.rgb;
            shares += share;
            shares2 += share * share;
        }
    }
    const vec3 factor = (known / shares + kDarkest) / (seen / shares + kDarkest);
    // Taps are about as far apart as records.
    const vec3 sure = beyond_chance(factor, seen / shares, squares / shares, shares * shares / shares2);
    balance[own] = vec4(clamp(sure, 1.0 / params.most_factor, params.most_factor), 1.0);
}
