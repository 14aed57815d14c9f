#version 460
#extension GL_GOOGLE_include_directive : require
// The surface that each pixel of a view shows, as the texel of a page. One invocation per pixel.
#include "lib/color/packed_albedo.glsl"
#include "lib/math/octahedral.glsl"
#include "shared/texture/texture.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;  // w: depth, 0: nothing was hit
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(binding = 2, rgba16f) uniform readonly image2D kd;
layout(std430, binding = 3) writeonly buffer Texels { SurfaceTexel texels[]; };
layout(std430, binding = 4) writeonly buffer Known { uint known[]; };  // pack_albedo

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), extent = imageSize(position_m);
    if (any(greaterThanEqual(pixel, extent))) return;
    const int index = pixel.y * extent.x + pixel.x;
    const vec4 hit = imageLoad(position_m, pixel), albedo = imageLoad(kd, pixel);
    const vec3 facing = imageLoad(normal, pixel).xyz;
    // Where records know nothing there is nothing to balance pictures with.
    const bool shown = hit.w > 0.0 && albedo.a > 0.0 && dot(facing, facing) > 0.0;
    const uvec3 bits = floatBitsToUint(hit.xyz);
    texels[index] = SurfaceTexel(bits.x, bits.y, bits.z, shown ? packSnorm2x16(to_octahedral(facing)) : kNoSurface);
    known[index] = pack_albedo(albedo.rgb, 0u);
}
