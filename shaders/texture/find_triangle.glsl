// The triangle that a texel shows: the first one in which its centre lies, else the nearest. The includer declares
//   Vertices, Triangles and Lists, as passes/texture/place_texels.h has them.
#ifndef PATINA_TEXTURE_FIND_TRIANGLE_GLSL
#define PATINA_TEXTURE_FIND_TRIANGLE_GLSL
#include "shared/texture/texture.h"

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

// A triangle and the point of it that is shown.
struct ShownPoint {
    bool found;
    uvec3 corners;  // vertices
    vec3 shares;    // of them
};

ShownPoint find_triangle(TextureTile tile, vec2 center) {
    Nearest best = Nearest(float(kGutterTexels) + 0.001, vec3(0.0));
    uint owner = 0u;
    bool found = false;
    for (uint i = 0u; i < tile.count; ++i) {
        const uint triangle = 3u * lists[tile.first + i];
        const vec2 a = place_of(vertices[triangles[triangle]]), b = place_of(vertices[triangles[triangle + 1u]]),
                   c = place_of(vertices[triangles[triangle + 2u]]);
        const Nearest here = nearest_in(a, b, c, center);
        if (here.distance_px >= best.distance_px) continue;
        best = here;
        owner = triangle;
        found = true;
        if (here.distance_px == 0.0) break;
    }
    const uvec3 corners = found ? uvec3(triangles[owner], triangles[owner + 1u], triangles[owner + 2u]) : uvec3(0u);
    return ShownPoint(found, corners, best.shares);
}

#endif
