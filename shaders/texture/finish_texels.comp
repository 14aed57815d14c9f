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
#include "texture/around.glsl"

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
    const Around around = around_of(vec2(texel) + vec2(0.5, float(params.first_row) + 0.5), position_m,
                                    ivec2(params.blocks_x, params.blocks_y), params.reach_m);
    if (sum.a <= 0.0) {
        albedo[index] = pack_albedo(around.albedo.a > 0.0 ? around.albedo.rgb : by_records, 1u);
    } else {
        albedo[index] = pack_albedo(around.factor.a > 0.0 ? around.factor.rgb * sum.rgb / sum.a : by_records, 2u);
    }
}
