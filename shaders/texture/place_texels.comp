#version 460
#extension GL_GOOGLE_include_directive : require
// Finds which point of the surface each texel of a band of rows shows: that of the first triangle in which its centre
// lies, else the nearest point of a triangle within the gutter. One group per tile.
#include "lib/color/packed_albedo.glsl"
#include "lib/math/octahedral.glsl"
#include "shared/texture/texture.h"

layout(local_size_x = kTextureTile, local_size_y = kTextureTile) in;
layout(std430, binding = 0) readonly buffer Vertices { TextureVertex vertices[]; };
layout(std430, binding = 1) readonly buffer Triangles { uint triangles[]; };  // three vertices each
layout(std430, binding = 2) readonly buffer Tiles { TextureTile tiles[]; };   // of the band
layout(std430, binding = 3) readonly buffer Lists { uint lists[]; };          // triangles, ascending in each tile
layout(std430, binding = 4) writeonly buffer Texels { SurfaceTexel texels[]; };
layout(std430, binding = 5) writeonly buffer Known { uint known[]; };  // what records know: pack_albedo
layout(push_constant) uniform Push { PlaceTexelsParams params; };
#include "texture/find_triangle.glsl"

void main() {
    const uvec2 texel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(texel, params.extent))) return;
    const TextureTile tile = tiles[gl_WorkGroupID.y * params.tiles_x + gl_WorkGroupID.x];
    const ShownPoint shown = find_triangle(tile, vec2(texel) + vec2(0.5, float(params.first_row) + 0.5));
    const uint at = texel.y * params.extent.x + texel.x;
    if (!shown.found) {
        texels[at] = SurfaceTexel(0u, 0u, 0u, kNoSurface);
        known[at] = 0u;
        return;
    }
    const TextureVertex a = vertices[shown.corners.x], b = vertices[shown.corners.y], c = vertices[shown.corners.z];
    const vec3 position_m =
        shown.shares.x * a.position_m.xyz + shown.shares.y * b.position_m.xyz + shown.shares.z * c.position_m.xyz;
    const vec3 kd = shown.shares.x * a.kd.rgb + shown.shares.y * b.kd.rgb + shown.shares.z * c.kd.rgb;
    const vec3 normal = shown.shares.x * a.normal.xyz + shown.shares.y * b.normal.xyz + shown.shares.z * c.normal.xyz;
    const vec3 facing = dot(normal, normal) > 1e-12 ? normal : vec3(0.0, 0.0, 1.0);
    const uvec3 bits = floatBitsToUint(position_m);
    texels[at] = SurfaceTexel(bits.x, bits.y, bits.z, packSnorm2x16(to_octahedral(facing)));
    known[at] = pack_albedo(kd, 0u);
}
