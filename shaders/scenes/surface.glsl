// What a synthetic scene's surfaces look like where rays hit them: surface_at(ray, hit). Bindings 5 to 7
// (SceneModel::bind_surfaces).
#ifndef PATINA_SYNTHETIC_SURFACE_GLSL
#define PATINA_SYNTHETIC_SURFACE_GLSL
#include "scenes/scene.glsl"

layout(std430, binding = 5) readonly buffer Objects { SceneObject objects[]; };
layout(std430, binding = 6) readonly buffer TriangleSurfaces { SceneTriangle triangle_surfaces[]; };
layout(binding = 7) uniform sampler2D texels;  // rgb: kd; the pictures of all objects

// Rays leave from this far above a surface, times 1 m plus the point's largest coordinate: well above what fp32 loses
// there, well below a millimetre in a room.
const float kLift = 2e-5;

struct Surface {
    vec3 point_m;
    vec3 normal;    // to shade with, unit length, towards the viewer
    vec3 lifted_m;  // where rays that leave the surface start: on the viewer's side of it
    vec3 kd;
    vec4 ks_alpha;
    uint object_id;
};

// A point of a surface: what depends on the kind of shape.
struct Place {
    vec3 geometric;  // normal of the shape itself; unit length, either side
    vec3 normal;     // interpolated
    vec2 uv;
    vec3 raised_m;  // by how much the point lies below the smooth surface that interpolated normals suggest
    uint object;
};

// Angle of the vector (x, y) from the x axis, in [-pi, pi], to 2e-7; GLSL's own may be off by 2e-4. Polynomial: Cephes
// atanf.
float angle_of(float y, float x) {
    const float longer = max(abs(x), abs(y)), shorter = min(abs(x), abs(y));
    const float tangent = shorter / max(longer, 1e-30);
    const bool beyond = tangent > 0.41421356;  // tan(pi / 8)
    const float z = beyond ? (tangent - 1.0) / (tangent + 1.0) : tangent;
    const float z2 = z * z;
    const float series =
        (((8.05374449538e-2 * z2 - 1.38776856032e-1) * z2 + 1.99777106478e-1) * z2 - 3.33329491539e-1) * z2 * z + z;
    float angle = series + (beyond ? 0.78539816340 : 0.0);
    angle = abs(y) > abs(x) ? 1.57079632679 - angle : angle;
    angle = x < 0.0 ? 3.14159265359 - angle : angle;
    return y < 0.0 ? -angle : angle;
}

// (u, v) as scenes/description/scene.h says; `face` is the axis of the slab that was hit.
vec2 part_uv(ScenePart part, vec3 p, bvec3 face) {
    if (any(face)) return face.x ? p.yz : face.y ? p.xz : p.xy;
    const float radius_m = sqrt(part.size.w);
    const float along = part.quadric.y > 0.0 ? radius_m * angle_of(p.y, length(p.xz)) : p.y;
    return vec2(radius_m * angle_of(p.x, p.z), along);
}

Place part_place(uint index, Ray ray, float t) {
    const ScenePart part = load_part(index);
    const LocalRay local = in_part(part, ray);
    const vec3 p = local.origin_m + t * local.direction;
    vec3 slab_enter, slab_leave;
    slab_intervals(part, local, slab_enter, slab_leave);
    const vec2 quadric = quadric_interval(part, local);
    // The side that bounds the interval whose end the hit is.
    const bool entering = max(largest(slab_enter), quadric.x) > 0.0;
    const vec3 sides = entering ? slab_enter : -slab_leave;
    const bool on_quadric = (entering ? quadric.x : -quadric.y) > largest(sides);
    const bvec3 face =
        bvec3(!on_quadric && sides.x >= max(sides.y, sides.z), !on_quadric && sides.y > sides.x && sides.y >= sides.z,
              !on_quadric && sides.z > max(sides.x, sides.y));
    const vec3 normal = on_quadric ? normalize(part.quadric.xyx * p) : vec3(face);
    const vec3 world = normal.x * part.row_x.xyz + normal.y * part.row_y.xyz + normal.z * part.row_z.xyz;
    return Place(world, world, part_uv(part, p, face), vec3(0.0), uint(part.quadric.z));
}

// How far a point is below the tangent plane of a corner on the viewer's side.
vec3 below_corner(vec3 point_m, vec3 corner_m, vec3 normal) {
    return max(0.0, -dot(point_m - corner_m, normal)) * normal;
}

Place triangle_place(uint index, Ray ray, float t) {
    const vec3 a = imageLoad(shapes, texel_of(index * kTriangleTexels)).xyz;
    const vec3 b = imageLoad(shapes, texel_of(index * kTriangleTexels + 1u)).xyz;
    const vec3 c = imageLoad(shapes, texel_of(index * kTriangleTexels + 2u)).xyz;
    const SceneTriangle s = triangle_surfaces[index];
    const vec3 volumes = edge_volumes(a, b, c, ray);
    const vec3 share = volumes / (volumes.x + volumes.y + volumes.z);
    const vec3 normal = normalize(share.x * s.normal_a.xyz + share.y * s.normal_b.xyz + share.z * s.normal_c.xyz);
    const vec2 uv = vec2(dot(share, vec3(s.normal_a.w, s.normal_b.w, s.normal_c.w)), dot(share, s.v.xyz));
    // Shadows of a facet on its own smooth surface would show the facets along the terminator; light is looked for from
    // a point on the smooth surface instead (Hanika, Hacking the Shadow Terminator, Ray Tracing Gems II).
    const vec3 point_m = ray.origin_m + t * ray.direction;
    const float side = dot(normal, ray.direction) > 0.0 ? -1.0 : 1.0;
    const vec3 raised_m = share.x * below_corner(point_m, a, side * s.normal_a.xyz) +
                          share.y * below_corner(point_m, b, side * s.normal_b.xyz) +
                          share.z * below_corner(point_m, c, side * s.normal_c.xyz);
    return Place(s.normal.xyz, normal, uv, raised_m, uint(s.normal.w));
}

// An object's kd at (u, v): bilinear, repeated.
vec3 kd_at(SceneObject object, vec2 uv) {
    const vec2 size = vec2(object.texture_size);
    const vec2 at = uv * object.texels_per_uv - 0.5;
    const vec2 low = floor(at);
    vec2 first = low - size * floor(low / size);
    // The division may round to the wrong side of an integer.
    first = mix(first, first - size, greaterThanEqual(first, size));
    first = mix(first, first + size, lessThan(first, vec2(0.0)));
    const uvec2 i = uvec2(first);
    const uvec2 j = mix(i + 1u, uvec2(0u), equal(i + 1u, object.texture_size));
    const uvec2 row = object.first_texel + object.texture_size.x * uvec2(i.y, j.y);
    const vec3 top_left = texelFetch(texels, texel_of(row.x + i.x), 0).rgb;
    const vec3 top_right = texelFetch(texels, texel_of(row.x + j.x), 0).rgb;
    const vec3 bottom_left = texelFetch(texels, texel_of(row.y + i.x), 0).rgb;
    const vec3 bottom_right = texelFetch(texels, texel_of(row.y + j.x), 0).rgb;
    // This form of the mean yields equal texels exactly.
    const vec2 share = at - low;
    const vec3 top = top_left + share.x * (top_right - top_left);
    const vec3 bottom = bottom_left + share.x * (bottom_right - bottom_left);
    return top + share.y * (bottom - top);
}

// The surface that a ray has hit. A ray that hit nothing gets some surface, too, which means nothing: invocations wait
// for one another anyway.
Surface surface_at(Ray ray, Hit hit) {
    const bool missed = hit.primitive == kNothingHit;
    const bool is_triangle = !missed && (hit.primitive & kTriangleHit) != 0u;
    const float t = missed ? 0.0 : hit.t;
    Place place = part_place(missed || is_triangle ? 0u : hit.primitive, ray, t);
    if (is_triangle) place = triangle_place(hit.primitive & ~kTriangleHit, ray, t);
    const vec3 point_m = ray.origin_m + t * ray.direction;
    const vec3 geometric = dot(place.geometric, ray.direction) > 0.0 ? -place.geometric : place.geometric;
    const vec3 normal = dot(place.normal, geometric) < 0.0 ? -place.normal : place.normal;
    const SceneObject object = objects[place.object];
    Surface surface;
    surface.point_m = point_m;
    // A viewer below the horizon of the interpolated normal would see nothing of the BRDF.
    surface.normal = dot(normal, ray.direction) < 0.0 ? normal : geometric;
    surface.lifted_m = point_m + place.raised_m + kLift * (1.0 + largest(abs(point_m))) * geometric;
    surface.kd = kd_at(object, place.uv);
    surface.ks_alpha = object.ks_alpha;
    surface.object_id = object.id;
    return surface;
}

#endif
