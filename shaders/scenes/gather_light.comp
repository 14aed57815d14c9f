// Light that reaches a camera by random samples; see scenes/render/gather_light.h.
#version 460
#extension GL_GOOGLE_include_directive : require
// Paths soon go their own ways, so that a bundle has little to share; and SwiftShader takes many minutes to compile
// this shader for four of them.
#define BUNDLE_RAYS 1u
#include "lib/brdf/ward.glsl"
#include "lib/camera/camera.glsl"
#include "lib/lighting/lamp_emission.glsl"
#include "lib/math/pi.glsl"
#include "lib/math/random.glsl"
#include "lib/math/sampling.glsl"
#include "scenes/environment.glsl"
#include "shared/scenes/gather_light.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(constant_id = 0) const uint kShadows = 0u;      // of lamps
layout(constant_id = 1) const uint kDirect = 0u;       // whether the first vertex asks for lamps
layout(constant_id = 2) const uint kEnvironment = 0u;  // whether there is one
layout(rgba32f, binding = 10) uniform image2D radiance;
layout(binding = 11) uniform sampler2D depth_m;
layout(binding = 12) uniform usampler2D object_id;
layout(binding = 13) uniform sampler2D normal;
layout(binding = 14) uniform sampler2D kd;
layout(binding = 15) uniform sampler2D ks_alpha;
layout(std430, binding = 16) readonly buffer Lifted { vec4 lifted_m[]; };
layout(push_constant) uniform Push { GatherLightParams params; };

const float kFar_m = 1e6;  // a point in a direction from afar, for shadow rays
const uint kBounceWay =
    0xffffu;  // the dimension of the direction in which a path goes on; those of lights count from 0
const float kBelowOne = 0.99999994;

// Where a path meets a surface; throughput 0 where it has ended.
struct Vertex {
    Surface surface;
    vec3 to_viewer;
    vec3 throughput;
};

// A straight way from a vertex to light, and what the pixel gains by it if nothing stands there.
struct Way {
    vec3 end_m;
    vec3 light;
};

float mean(vec3 v) { return (v.x + v.y + v.z) / 3.0; }

bool ended(Vertex v) { return v.throughput == vec3(0.0); }

// Random words for a way from the vertex of a path at a depth. Those at the camera's own surface cover the square
// evenly over a pixel's samples, which lowers the noise; farther ones are independent, because what they find depends
// on the ways before, too.
uvec4 words_for(uvec2 stream, uint index, uint depth, uint way) {
    return depth == 0u ? stratified_words(stream, index, way) : random_words(stream, index, depth << 16u | way);
}

// The part of the light from a direction that reaches the pixel, per unit of irradiance across that direction.
vec3 reflected(Vertex v, vec3 to_light) {
    const Surface s = v.surface;
    return v.throughput * ward(s.kd, s.ks_alpha.rgb, s.ks_alpha.a, s.normal, to_light, v.to_viewer) *
           max(dot(s.normal, to_light), 0.0);
}

// How often a path follows the Ward lobe, not the diffuse one: as often as the albedos say.
float lobe_share(Surface s) { return mean(s.ks_alpha.rgb) / max(mean(s.kd) + mean(s.ks_alpha.rgb), 1e-20); }

vec3 draw_bounce(Vertex v, vec2 u) {
    const Surface s = v.surface;
    const float share = lobe_share(s);
    if (u.x < share) return sample_ward(s.ks_alpha.a, s.normal, v.to_viewer, vec2(min(u.x / share, kBelowOne), u.y));
    return basis_around(s.normal) * sample_cosine(vec2(min((u.x - share) / (1.0 - share), kBelowOne), u.y));
}

// The density of draw_bounce() in a direction, of either lobe.
float bounce_density(Vertex v, vec3 to_light) {
    const Surface s = v.surface;
    const float diffuse = max(dot(s.normal, to_light), 0.0) / kPi;
    return mix(diffuse, ward_density(s.ks_alpha.a, s.normal, to_light, v.to_viewer), lobe_share(s));
}

// To a lamp, in a direction drawn from the cone under which it is seen; from inside, the half space around its centre.
Way way_to_lamp(Vertex v, PointLight lamp, vec2 u) {
    const vec3 to_center_m = lamp.position_m.xyz - v.surface.point_m;
    const float distance2 = max(dot(to_center_m, to_center_m), 1e-20);
    const float radius2 = lamp.position_m.w * lamp.position_m.w;
    const float sin2 = min(radius2 / distance2, 1.0);
    const float cap_height = sin2 / (1.0 + sqrt(1.0 - sin2));
    const vec3 local = sample_cap(cap_height, u);
    const vec3 to_light = basis_around(to_center_m * inversesqrt(distance2)) * local;
    const float across2 = distance2 * dot(local.xy, local.xy);
    const float reach_m = max(sqrt(distance2) * local.z - sqrt(max(radius2 - across2, 0.0)), 0.0);
    // Radiance times solid angle: I / (pi r^2) * 2 pi cap_height, without the division by r.
    const vec3 irradiance = intensity_from(lamp, to_light) * (2.0 / ((2.0 - cap_height) * max(distance2, radius2)));
    return Way(v.surface.point_m + reach_m * to_light, reflected(v, to_light) * irradiance);
}

// The largest irradiance that a lamp may cause, but for a factor.
float strength(PointLight lamp, vec3 point_m) {
    const vec3 offset_m = lamp.position_m.xyz - point_m;
    return mean(lamp.intensity.rgb) / max(dot(offset_m, offset_m), max(lamp.position_m.w * lamp.position_m.w, 1e-12));
}

// To one lamp for all, picked in proportion to its strength.
Way way_to_any_lamp(Vertex v, vec3 u) {
    float total = 0.0;
    for (uint i = 0u; i < scene.light_count; ++i) total += strength(lights[i].light, v.surface.point_m);
    uint picked = 0u;
    float picked_strength = 0.0, left = u.z * total;
    for (uint i = 0u; i < scene.light_count; ++i) {
        const float own = strength(lights[i].light, v.surface.point_m);
        const bool reached = left >= 0.0 && own > 0.0;
        picked = reached ? i : picked;
        picked_strength = reached ? own : picked_strength;
        left -= own;
    }
    Way way = way_to_lamp(v, lights[picked].light, u.xy);
    way.light *= picked_strength > 0.0 ? total / picked_strength : 0.0;
    return way;
}

Way way_to_far_light(Vertex v, uvec4 words) {
    const FarLight far = draw_far_light(words);
    const float density = max(far.density, 1e-20);
    const float weight = power_heuristic(density, bounce_density(v, far.direction)) / density;
    return Way(v.surface.point_m + kFar_m * far.direction, reflected(v, far.direction) * far.radiance * weight);
}

// The light that vertices see on straight ways: from all lamps at the first one, from one lamp at others; from afar.
void add_light(Vertex vertices[BUNDLE_RAYS], uvec2 streams[BUNDLE_RAYS], uint index, uint depth,
               inout vec3 sums[BUNDLE_RAYS]) {
    const uint lamp_ways = depth == 0u ? (kDirect != 0u ? scene.light_count : 0u) : min(scene.light_count, 1u);
    for (uint i = 0u; i < lamp_ways + kEnvironment; ++i) {
        Way ways[BUNDLE_RAYS];
        Ray rays[BUNDLE_RAYS];
        bool blocked[BUNDLE_RAYS];
        EACH_RAY {
            const uvec4 words = words_for(streams[k], index, depth, i);
            const vec4 u = unit_interval(words);
            if (i == lamp_ways)
                ways[k] = way_to_far_light(vertices[k], words);
            else if (depth == 0u)
                ways[k] = way_to_lamp(vertices[k], lights[i].light, u.xy);
            else
                ways[k] = way_to_any_lamp(vertices[k], u.xyz);
            rays[k] = Ray(vertices[k].surface.lifted_m, ways[k].end_m - vertices[k].surface.lifted_m);
            // What has ended is no surface: its own reflectance may be no number.
            blocked[k] = ended(vertices[k]) || ways[k].light == vec3(0.0);
        }
        if (kShadows != 0u || i == lamp_ways) find_occluded(rays, blocked);
        EACH_RAY sums[k] += blocked[k] ? vec3(0.0) : ways[k].light;
    }
}

// Follows each path to its next vertex, or out of the scene, where it may find light from afar.
void go_on(inout Vertex vertices[BUNDLE_RAYS], uvec2 streams[BUNDLE_RAYS], uint index, uint depth,
           inout vec3 sums[BUNDLE_RAYS]) {
    Ray rays[BUNDLE_RAYS];
    Hit hits[BUNDLE_RAYS];
    float densities[BUNDLE_RAYS];
    EACH_RAY {
        const vec4 u = unit_interval(words_for(streams[k], index, depth, kBounceWay));
        rays[k] = Ray(vertices[k].surface.lifted_m, draw_bounce(vertices[k], u.xy));
        densities[k] = bounce_density(vertices[k], rays[k].direction);
        const vec3 throughput = reflected(vertices[k], rays[k].direction) / densities[k];
        vertices[k].throughput = densities[k] > 0.0 && !ended(vertices[k]) ? throughput : vec3(0.0);
        hits[k] = Hit(ended(vertices[k]) ? 0.0 : kMiss, kNothingHit);  // at distance 0 nothing is looked for
    }
    traverse(rays, false, hits);
    EACH_RAY {
        const bool missed = hits[k].primitive == kNothingHit;
        if (kEnvironment != 0u) {
            const FarLight far = far_light_from(rays[k].direction);
            const vec3 light = vertices[k].throughput * far.radiance * power_heuristic(densities[k], far.density);
            sums[k] += missed && !ended(vertices[k]) ? light : vec3(0.0);
        }
        vertices[k] =
            Vertex(surface_at(rays[k], hits[k]), -rays[k].direction, missed ? vec3(0.0) : vertices[k].throughput);
    }
}

// The mean of this dispatch's samples, times its share of all samples.
void gather(Vertex first[BUNDLE_RAYS], uvec2 streams[BUNDLE_RAYS], out vec3 shares[BUNDLE_RAYS]) {
    vec3 sums[BUNDLE_RAYS];
    EACH_RAY sums[k] = vec3(0.0);
    for (uint index = params.first_sample; index < params.first_sample + params.sample_count; ++index) {
        Vertex vertices[BUNDLE_RAYS] = first;
        for (uint depth = 0u; depth <= params.bounces; ++depth) {
            add_light(vertices, streams, index, depth, sums);
            if (depth < params.bounces || kEnvironment != 0u) go_on(vertices, streams, index, depth, sums);
        }
    }
    EACH_RAY shares[k] = sums[k] / float(params.samples);
}

// What the camera sees at a pixel; a path that has ended where this is no surface, or beyond the image's edge.
Vertex load(ivec2 pixel, Ray ray) {
    Surface s;
    s.point_m = ray.origin_m + texelFetch(depth_m, pixel, 0).x * ray.direction;
    s.normal = texelFetch(normal, pixel, 0).xyz;
    s.lifted_m = lifted_m[min(uint(pixel.y), params.camera.extent.y - 1u) * params.camera.extent.x + uint(pixel.x)].xyz;
    s.kd = texelFetch(kd, pixel, 0).rgb;
    s.ks_alpha = texelFetch(ks_alpha, pixel, 0);
    s.object_id = texelFetch(object_id, pixel, 0).x;
    return Vertex(s, -normalize(ray.direction), vec3(s.object_id != 0u ? 1.0 : 0.0));
}

void store(ivec2 pixel, vec3 gathered, vec3 to_viewer) {
    if (any(greaterThanEqual(uvec2(pixel), params.camera.extent))) return;
    vec4 color = imageLoad(radiance, pixel) + vec4(gathered, 0.0);
    if (kEnvironment != 0u && color.a == 0.0) color.rgb = far_light_from(-to_viewer).radiance;
    imageStore(radiance, pixel, color);
}

void main() {
    const uvec2 corner = gl_GlobalInvocationID.xy * uvec2(1u, BUNDLE_RAYS);
    if (any(greaterThanEqual(corner, params.camera.extent))) return;
    const vec3 center_m = camera_center_m(params.camera);
    Vertex first[BUNDLE_RAYS];
    uvec2 streams[BUNDLE_RAYS];
    vec3 shares[BUNDLE_RAYS];
    EACH_RAY {
        const uvec2 pixel = corner + uvec2(0u, k);
        const vec3 direction = to_world_direction(params.camera, unproject(params.camera, vec2(pixel)));
        first[k] = load(ivec2(pixel), Ray(center_m, direction));
        streams[k] = random_stream(params.seed, params.frame_index, pixel.y * params.camera.extent.x + pixel.x);
    }
    gather(first, streams, shares);
    EACH_RAY store(ivec2(corner + uvec2(0u, k)), shares[k], first[k].to_viewer);
}
