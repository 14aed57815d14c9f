#version 460
#extension GL_GOOGLE_include_directive : require
// The means over each block of the texels that a picture shows. Where charts meet in a block only one of them counts:
// what lies near the first such texel. One invocation per block of a band.
#include "lib/color/packed_albedo.glsl"
#include "shared/texture/texture.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Texels { SurfaceTexel texels[]; };
layout(std430, binding = 1) readonly buffer Sums { vec4 sums[]; };
layout(std430, binding = 2) readonly buffer Known { uint known[]; };
layout(std430, binding = 3) buffer Blocks { TextureBlock blocks[]; };  // of the page, row by row
layout(push_constant) uniform Push { AverageTexelsParams params; };

const float kOneSurface_m = 0.06;

void main() {
    const uvec2 block = gl_GlobalInvocationID.xy;
    const uvec2 first = block * kTextureBlock;
    if (any(greaterThanEqual(first, params.extent))) return;
    const uvec2 end = min(first + kTextureBlock, params.extent);
    vec3 origin_m = vec3(0.0), position_m = vec3(0.0), seen = vec3(0.0), squares = vec3(0.0), by_records = vec3(0.0);
    float count = 0.0;
    for (uint i = 0u; i < kTextureBlock * kTextureBlock; ++i) {
        const uvec2 at = first + uvec2(i % kTextureBlock, i / kTextureBlock);
        if (any(greaterThanEqual(at, end))) continue;
        const uint index = at.y * params.extent.x + at.x;
        const SurfaceTexel texel = texels[index];
        if (texel.normal == kNoSurface) continue;
        const vec4 sum = sums[index];
        if (sum.a <= 0.0) continue;
        const vec3 here_m = uintBitsToFloat(uvec3(texel.x, texel.y, texel.z));
        if (count == 0.0) origin_m = here_m;
        if (distance(here_m, origin_m) > kOneSurface_m) continue;
        position_m += here_m - origin_m;
        const vec3 albedo = sum.rgb / sum.a;
        seen += albedo;
        squares += albedo * albedo;
        by_records += unpack_albedo(known[index]);
        count += 1.0;
    }
    const uint page_block = (params.first_row / kTextureBlock + block.y) * params.blocks_x + block.x;
    const float share = 1.0 / max(count, 1.0);
    blocks[page_block] = TextureBlock(vec4(origin_m + share * position_m, count), vec4(share * seen, 0.0),
                                      vec4(share * squares, 0.0), vec4(share * by_records, 0.0));
}
