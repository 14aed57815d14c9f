// The geometry and lights of a synthetic scene, and how to follow rays through it. For every pass that traces rays:
//
//   trace(rays, hits)             the first hit of each ray of a bundle
//   find_occluded(rays, blocked)  whether something stands between the two ends of each ray
//
// A bundle is BUNDLE_RAYS rays (kBundleRays, unless the includer defines another number before) that one invocation
// traces together, so that they share the loads of nodes and shapes;
// EACH_RAY runs over it. Bundles are fast where their rays are near one another, and faster still where all start in
// one and the same point (pass the same variable: the arithmetic that depends on it alone is then done once).
// Lamps are no part of the geometry: they never block light; see hit_lamps().
//
// Bindings 0 to 3 are declared here (SceneModel::bind_geometry), 5 to 7 in scenes/surface.glsl; a pass's own begin
// at 8. Images are few: a stage has 8 of them. Specialization constants and push constants are the pass's own.
#ifndef PATINA_SYNTHETIC_SCENE_GLSL
#define PATINA_SYNTHETIC_SCENE_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "shared/scenes/scene.h"

layout(std140, binding = 0) uniform Scene { SceneInfo scene; };
layout(rgba32ui, binding = 1) uniform readonly uimage2D nodes;  // SceneNode, in kNodeOrders orders
layout(rgba32f, binding = 2) uniform readonly image2D shapes;   // triangles, kTriangleTexels each; then ScenePart
layout(std430, binding = 3) readonly buffer Lights { SceneLight lights[]; };

#ifndef BUNDLE_RAYS
#define BUNDLE_RAYS kBundleRays
#endif

const float kMiss = 1e30;
// By how much of its size a triangle is taken larger, so that no ray passes between two that share an edge or a corner;
// a few roundings of fp32.
const float kEdgeTolerance = 1e-6;
// By how much the far side of a box is moved away: three roundings (Ize, Robust BVH Ray Traversal, 2013).
const float kFarMargin = 1.0000004;

#define EACH_RAY [[unroll]] for (uint k = 0u; k < BUNDLE_RAYS; ++k)

struct Ray {
    vec3 origin_m;
    vec3 direction;  // of any length; distances along the ray are multiples of it
};

struct Hit {
    float t;         // in (0, kMiss); kMiss where nothing was hit
    uint primitive;  // a part, a triangle | kTriangleHit, or kNothingHit
};

ivec2 texel_of(uint element) { return ivec2(element % kTexelRow, element / kTexelRow); }

// Slabs and quadrics divide by the components: a tiny one stands for 0, so that no infinity or NaN arises.
vec3 away_from_zero(vec3 direction) { return mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20))); }

// A ray within a part's frame, and what the part's surface is made of.
struct LocalRay {
    vec3 origin_m;
    vec3 direction;
};

LocalRay in_part(ScenePart part, Ray ray) {
    const mat3 rotation = mat3(part.row_x.xyz, part.row_y.xyz, part.row_z.xyz);
    return LocalRay(ray.origin_m * rotation + vec3(part.row_x.w, part.row_y.w, part.row_z.w),
                    away_from_zero(ray.direction * rotation));
}

ScenePart load_part(uint index) {
    const uint first = scene.first_part_texel + index * kPartTexels;
    return ScenePart(imageLoad(shapes, texel_of(first)), imageLoad(shapes, texel_of(first + 1u)),
                     imageLoad(shapes, texel_of(first + 2u)), imageLoad(shapes, texel_of(first + 3u)),
                     imageLoad(shapes, texel_of(first + 4u)));
}

// Where a line enters and leaves the quadric of a part. From the line's point nearest to the axis: the textbook's
// b^2 - 4ac would cancel at a distance of many radii.
vec2 quadric_interval(ScenePart part, LocalRay ray) {
    const vec3 factors = part.quadric.xyx;
    const float a = max(dot(factors * ray.direction, ray.direction), 1e-20);
    const float nearest = -dot(factors * ray.origin_m, ray.direction) / a;
    const vec3 p = ray.origin_m + nearest * ray.direction;
    const float inside = part.size.w - dot(factors * p, p);
    const float reach = sqrt(max(inside, 0.0) / a);
    return inside >= 0.0 ? vec2(nearest - reach, nearest + reach) : vec2(kMiss, -kMiss);
}

// Where a line enters and leaves each slab of a part.
void slab_intervals(ScenePart part, LocalRay ray, out vec3 enter, out vec3 leave) {
    const vec3 low = (-part.size.xyz - ray.origin_m) / ray.direction;
    const vec3 high = (part.size.xyz - ray.origin_m) / ray.direction;
    enter = min(low, high);
    leave = max(low, high);
}

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }
float smallest(vec3 v) { return min(v.x, min(v.y, v.z)); }

// The first point of a part's surface along a ray, from outside or from inside.
float hit_part(ScenePart part, Ray ray) {
    const LocalRay local = in_part(part, ray);
    vec3 slab_enter, slab_leave;
    slab_intervals(part, local, slab_enter, slab_leave);
    const vec2 quadric = quadric_interval(part, local);
    const float enter = max(largest(slab_enter), quadric.x);
    const float leave = min(smallest(slab_leave), quadric.y);
    const float t = enter > 0.0 ? enter : leave;
    return enter <= leave && t > 0.0 ? t : kMiss;
}

// The volumes that the ray's direction spans with a triangle's edges, twice over; all of one sign where the line hits
// it, and in proportion to the barycentric coordinates of a, b, c. Triangles that share an edge find the very same
// value with opposite signs, which `precise` keeps the compiler from spoiling.
vec3 edge_volumes(vec3 a, vec3 b, vec3 c, Ray ray) {
    const vec3 pa = a - ray.origin_m, pb = b - ray.origin_m, pc = c - ray.origin_m;
    precise const vec3 side_a = cross(c - b, pc + pb);
    precise const vec3 side_b = cross(a - c, pa + pc);
    precise const vec3 side_c = cross(b - a, pb + pa);
    precise const vec3 volumes =
        vec3(dot(side_a, ray.direction), dot(side_b, ray.direction), dot(side_c, ray.direction));
    return volumes;
}

float hit_triangle(vec3 a, vec3 b, vec3 c, Ray ray) {
    const vec3 volumes = edge_volumes(a, b, c, ray);
    const float tolerance = kEdgeTolerance * abs(volumes.x + volumes.y + volumes.z);
    const bool inside = smallest(volumes) >= -tolerance || largest(volumes) <= tolerance;
    const vec3 normal = cross(b - a, c - a);
    const float t = dot(normal, a - ray.origin_m) / dot(normal, ray.direction);
    return inside && t > 0.0 ? t : kMiss;  // a NaN, of a triangle seen edge-on, is no hit
}

// With `any_hit` the first hit found ends a ray: nothing is nearer than its distance, 0.
void keep(inout Hit hit, float t, uint primitive, bool any_hit) {
    const bool nearer = t < hit.t;
    hit.t = nearer ? (any_hit ? 0.0 : t) : hit.t;
    hit.primitive = nearer ? primitive : hit.primitive;
}

// Replaces what is farther than the scene's geometry in `hits`. Both trees are walked without a stack: the list holds
// their nodes depth-first, near children first for each octant of directions, and a missed box names the node to go on
// with (Torres et al., Ray Casting using a Roped BVH with CUDA, 2009). Any order finds the same hits.
void traverse(Ray rays[BUNDLE_RAYS], bool any_hit, inout Hit hits[BUNDLE_RAYS]) {
    vec3 inverse[BUNDLE_RAYS];
    vec3 mean = vec3(0.0);
    EACH_RAY {
        inverse[k] = 1.0 / away_from_zero(rays[k].direction);
        mean += rays[k].direction;
    }
    const uint end = scene.node_count;
    const uint order = (mean.x < 0.0 ? 1u : 0u) | (mean.y < 0.0 ? 2u : 0u) | (mean.z < 0.0 ? 4u : 0u);
    const uint first_texel = order * end * kNodeTexels;
    uint node = 0u;
    while (node < end) {
        const uint texel = first_texel + node * kNodeTexels;
        const uvec4 low_skip = imageLoad(nodes, texel_of(texel));
        const uvec4 high_leaf = imageLoad(nodes, texel_of(texel + 1u));
        const vec3 low = uintBitsToFloat(low_skip.xyz), high = uintBitsToFloat(high_leaf.xyz);
        bool entered = false;
        EACH_RAY {
            const vec3 to_low = (low - rays[k].origin_m) * inverse[k];
            const vec3 to_high = (high - rays[k].origin_m) * inverse[k];
            const float near = largest(min(to_low, to_high)), far = smallest(max(to_low, to_high)) * kFarMargin;
            entered = entered || (max(near, 0.0) <= min(far, hits[k].t) && hits[k].t > 0.0);
        }
        const uint leaf = entered ? high_leaf.w : 0u;
        const uint first = leaf >> kLeafIndexShift;
        const uint last = first + bitfieldExtract(leaf, 0, int(kLeafCountBits));
        const bool holds_parts = (leaf & kLeafParts) != 0u;
        node = entered ? node + 1u : low_skip.w;
        // Loops, not branches: software devices run both sides of a branch, but no loop that no invocation enters.
        for (uint i = first; i < (holds_parts ? first : last); ++i) {
            const vec3 a = imageLoad(shapes, texel_of(i * kTriangleTexels)).xyz;
            const vec3 b = imageLoad(shapes, texel_of(i * kTriangleTexels + 1u)).xyz;
            const vec3 c = imageLoad(shapes, texel_of(i * kTriangleTexels + 2u)).xyz;
            EACH_RAY keep(hits[k], hit_triangle(a, b, c, rays[k]), i | kTriangleHit, any_hit);
        }
        for (uint i = first; i < (holds_parts ? last : first); ++i) {
            const ScenePart part = load_part(i);
            EACH_RAY keep(hits[k], hit_part(part, rays[k]), i, any_hit);
        }
    }
}

// What each ray hits first.
void trace(Ray rays[BUNDLE_RAYS], out Hit hits[BUNDLE_RAYS]) {
    EACH_RAY hits[k] = Hit(kMiss, kNothingHit);
    traverse(rays, false, hits);
}

// Whether something stands between each ray's origin and origin_m + direction. Both ends must be clear of the surfaces
// that they belong to (see Surface.lifted_m). Rays blocked before are not followed.
void find_occluded(Ray rays[BUNDLE_RAYS], inout bool blocked[BUNDLE_RAYS]) {
    Hit hits[BUNDLE_RAYS];
    EACH_RAY hits[k] = Hit(blocked[k] ? 0.0 : 1.0, kNothingHit);
    traverse(rays, true, hits);
    EACH_RAY blocked[k] = hits[k].t == 0.0;
}

// What lamps the rays of a bundle meet nearer than `hits`: gives their distances to it, and the lamps' indices, or
// kNothingHit. A lamp is not seen from inside.
void hit_lamps(Ray rays[BUNDLE_RAYS], inout Hit hits[BUNDLE_RAYS], out uint lamps[BUNDLE_RAYS]) {
    EACH_RAY lamps[k] = kNothingHit;
    const uint end = scene.has_lamps != 0u ? scene.light_count : 0u;
    for (uint i = 0u; i < end; ++i) {
        const vec4 sphere = lights[i].light.position_m;
        EACH_RAY {
            const float length2 = dot(rays[k].direction, rays[k].direction);
            const vec3 to_center = sphere.xyz - rays[k].origin_m;
            const float nearest = dot(to_center, rays[k].direction) / length2;
            const vec3 p = nearest * rays[k].direction - to_center;
            const float inside = sphere.w * sphere.w - dot(p, p);
            const float enter = nearest - sqrt(max(inside, 0.0) / length2);
            const bool hit = sphere.w > 0.0 && inside >= 0.0 && enter > 0.0 && enter < hits[k].t;
            hits[k].t = hit ? enter : hits[k].t;
            lamps[k] = hit ? i : lamps[k];
        }
    }
}

#endif
