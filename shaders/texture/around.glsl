// What the balanced blocks around a place of a page agree on. Needs Blocks and Balance.
#ifndef PATINA_TEXTURE_AROUND_GLSL
#define PATINA_TEXTURE_AROUND_GLSL
#include "shared/texture/texture.h"

const float kFillReach_m = 0.03;

struct Around {
    vec4 factor;  // rgb: of pictures; a: 0 where no block is of this surface
    vec4 albedo;  // rgb: by pictures, balanced; of blocks nearer than kFillReach_m; a: 0 where there is none
};

// `place`: texels of the page, 0.5 in the middle of the first; `count`: the page's blocks; a block whose mean is
// farther than `reach_m` from `position_m` is of another surface.
Around around_of(vec2 place, vec3 position_m, ivec2 count, float reach_m) {
    const vec2 at = place / float(kTextureBlock) - 0.5;
    const ivec2 low = ivec2(floor(at));
    const vec2 t = at - vec2(low);
    Around sums = Around(vec4(0.0), vec4(0.0));
    for (int i = 0; i < 4; ++i) {
        const ivec2 step = ivec2(i & 1, i >> 1);
        const ivec2 block = clamp(low + step, ivec2(0), count - 1);
        const uint index = uint(block.y * count.x + block.x);
        const vec2 shares = mix(1.0 - t, t, vec2(step));
        const float share = shares.x * shares.y + 1e-4, away_m = distance(blocks[index].position_m.xyz, position_m);
        if (balance[index].a == 0.0 || away_m > reach_m) continue;
        sums.factor += share * balance[index];
        if (away_m <= kFillReach_m) sums.albedo += share * vec4(balance[index].rgb * blocks[index].seen.rgb, 1.0);
    }
    if (sums.factor.a > 0.0) sums.factor /= sums.factor.a;
    if (sums.albedo.a > 0.0) sums.albedo /= sums.albedo.a;
    return sums;
}

#endif
