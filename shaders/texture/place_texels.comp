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

// How near a triangle's border a texel is, and where.
struct Nearest {
    float distance_px;  // 0 within
    vec3 shares;        // of the three vertices at the nearest point
};

float cross_of(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// Along the edge from a to b: the share of b at the point nearest to p.
float share_along(vec2 a, vec2 b, vec2 p) {
    const vec2 edge = b - a;
    return clamp(dot(p - a, edge) / max(dot(edge, edge), 1e-12), 0.0, 1.0);
}

Nearest nearest_in(vec2 a, vec2 b, vec2 c, vec2 p) {
    const float area = cross_of(b - a, c - a);
    if (abs(area) > 1e-9) {
        const float s = cross_of(p - a, c - a) / area, t = cross_of(b - a, p - a) / area;
        if (s >= 0.0 && t >= 0.0 && s + t <= 1.0) return Nearest(0.0, vec3(1.0 - s - t, s, t));
    }
    const float ab = share_along(a, b, p), bc = share_along(b, c, p), ca = share_along(c, a, p);
    const float d_ab = distance(mix(a, b, ab), p), d_bc = distance(mix(b, c, bc), p), d_ca = distance(mix(c, a, ca), p);
    if (d_ab <= d_bc && d_ab <= d_ca) return Nearest(d_ab, vec3(1.0 - ab, ab, 0.0));
    if (d_bc <= d_ca) return Nearest(d_bc, vec3(0.0, 1.0 - bc, bc));
    return Nearest(d_ca, vec3(ca, 0.0, 1.0 - ca));
}

vec2 place_of(TextureVertex vertex) { return vec2(vertex.position_m.w, vertex.kd.w); }

void main() {
    const uvec2 texel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(texel, params.extent))) return;
    const TextureTile tile = tiles[gl_WorkGroupID.y * params.tiles_x + gl_WorkGroupID.x];
    const vec2 center = vec2(texel) + vec2(0.5, float(params.first_row) + 0.5);
    Nearest best = Nearest(float(kGutterTexels) + 0.001, vec3(0.0));
    uint owner = 0u;
    bool any_found = false;
    for (uint i = 0u; i < tile.count; ++i) {
        const uint triangle = 3u * lists[tile.first + i];
        const vec2 a = place_of(vertices[triangles[triangle]]), b = place_of(vertices[triangles[triangle + 1u]]),
                   c = place_of(vertices[triangles[triangle + 2u]]);
        const Nearest here = nearest_in(a, b, c, center);
        if (here.distance_px >= best.distance_px) continue;
        best = here;
        owner = triangle;
        any_found = true;
        if (here.distance_px == 0.0) break;
    }
    const uint at = texel.y * params.extent.x + texel.x;
    if (!any_found) {
        texels[at] = SurfaceTexel(0u, 0u, 0u, kNoSurface);
        known[at] = 0u;
        return;
    }
    const TextureVertex a = vertices[triangles[owner]], b = vertices[triangles[owner + 1u]],
                        c = vertices[triangles[owner + 2u]];
    const vec3 position_m =
        best.shares.x * a.position_m.xyz + best.shares.y * b.position_m.xyz + best.shares.z * c.position_m.xyz;
    const vec3 kd = best.shares.x * a.kd.rgb + best.shares.y * b.kd.rgb + best.shares.z * c.kd.rgb;
    const vec3 normal = best.shares.x * a.normal.xyz + best.shares.y * b.normal.xyz + best.shares.z * c.normal.xyz;
    const vec3 facing = dot(normal, normal) > 1e-12 ? normal : vec3(0.0, 0.0, 1.0);
    const uvec3 bits = floatBitsToUint(position_m);
    texels[at] = SurfaceTexel(bits.x, bits.y, bits.z, packSnorm2x16(to_octahedral(facing)));
    known[at] = pack_albedo(kd, 0u);
}
