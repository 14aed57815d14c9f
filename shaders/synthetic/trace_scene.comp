#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/ward.glsl"
#include "shared/trace_scene.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(constant_id = 0) const uint kShadows = 0u;
layout(std430, binding = 0) readonly buffer Objects { TraceObject objects[]; };
layout(std430, binding = 1) readonly buffer Lights { TraceLight lights[]; };
layout(rgba32f, binding = 2) uniform writeonly image2D radiance;
layout(r32f, binding = 3) uniform writeonly image2D depth_m;
layout(r32ui, binding = 4) uniform writeonly uimage2D object_id;
layout(rgba32f, binding = 5) uniform writeonly image2D normal;
layout(rgba32f, binding = 6) uniform writeonly image2D kd;
layout(rgba32f, binding = 7) uniform writeonly image2D ks_alpha;
layout(push_constant) uniform Push { TraceSceneParams params; };

const float kMiss = 1e30;
const float kShadowBias_m = 1e-4;  // well above what fp32 loses within 10 m, well below a millimetre of depth

// An invocation traces a bundle of rays, those through kTraceSceneRays pixels of one column.
#define EACH_RAY [[unroll]] for (uint k = 0u; k < kTraceSceneRays; ++k)

struct Ray {
    vec3 origin_m;
    vec3 direction;  // of any length; distances along the ray are multiples of it
};

struct Hit {
    float t;
    uint object;
};

struct Surface {
    vec3 point_m;
    vec3 normal;
    vec3 to_viewer;
    vec3 kd;
    vec4 ks_alpha;
};

Ray in_object(mat4 object_from_world, Ray ray) {
    const vec3 direction = mat3(object_from_world) * ray.direction;
    // The slab and plane tests divide by the components: 1e-20 stands for 0, so that no infinity or NaN arises.
    return Ray((object_from_world * vec4(ray.origin_m, 1.0)).xyz,
               mix(direction, vec3(1e-20), equal(direction, vec3(0.0))));
}

float hit_rectangle(Ray ray, vec2 half_size_m) {
    const float t = -ray.origin_m.z / ray.direction.z;
    const vec2 p = abs(ray.origin_m.xy + t * ray.direction.xy);
    return t > 0.0 && all(lessThanEqual(p, half_size_m)) ? t : kMiss;
}

// Where the ray enters each of a box's three slabs.
vec3 slab_entries(Ray ray, vec3 half_size_m) {
    return (-sign(ray.direction) * half_size_m - ray.origin_m) / ray.direction;
}

// From inside a box it is not seen, likewise a sphere.
float hit_box(Ray ray, vec3 half_size_m) {
    const vec3 entry = slab_entries(ray, half_size_m);
    const vec3 leave = (sign(ray.direction) * half_size_m - ray.origin_m) / ray.direction;
    const float t = max(entry.x, max(entry.y, entry.z));
    return t > 0.0 && t <= min(leave.x, min(leave.y, leave.z)) ? t : kMiss;
}

float hit_sphere(Ray ray, float radius_m) {
    // From the ray's point nearest to the centre: b^2 - 4ac would cancel at a distance of many radii.
    const float length2 = dot(ray.direction, ray.direction);
    const float nearest = -dot(ray.origin_m, ray.direction) / length2;
    const vec3 p = ray.origin_m + nearest * ray.direction;
    const float inside = radius_m * radius_m - dot(p, p);
    const float t = nearest - sqrt(max(inside, 0.0) / length2);
    return inside >= 0.0 && t > 0.0 ? t : kMiss;
}

void keep_nearer(inout Hit hit, float t, uint object) { hit = t < hit.t ? Hit(t, object) : hit; }

// What a bundle's rays hit first. Each object is loaded once for all of them: loads, not arithmetic, take the time.
void trace(Ray rays[kTraceSceneRays], out Hit hits[kTraceSceneRays]) {
    const uint boxes = params.rectangle_count;
    const uint spheres = boxes + params.box_count;
    const uint end = spheres + params.sphere_count;
    EACH_RAY hits[k] = Hit(kMiss, 0u);
    for (uint i = 0u; i < boxes; ++i) {
        const mat4 m = objects[i].object_from_world;
        const vec2 half_size_m = objects[i].half_size_m.xy;
        EACH_RAY keep_nearer(hits[k], hit_rectangle(in_object(m, rays[k]), half_size_m), i);
    }
    for (uint i = boxes; i < spheres; ++i) {
        const mat4 m = objects[i].object_from_world;
        const vec3 half_size_m = objects[i].half_size_m.xyz;
        EACH_RAY keep_nearer(hits[k], hit_box(in_object(m, rays[k]), half_size_m), i);
    }
    for (uint i = spheres; i < end; ++i) {
        const mat4 m = objects[i].object_from_world;
        const float radius_m = objects[i].half_size_m.x;
        EACH_RAY keep_nearer(hits[k], hit_sphere(in_object(m, rays[k]), radius_m), i);
    }
}

// The unit normal at a hit, world, towards the viewer.
vec3 normal_at(Ray world_ray, Hit hit) {
    const mat4 object_from_world = objects[hit.object].object_from_world;
    const Ray ray = in_object(object_from_world, world_ray);
    const vec3 entry = slab_entries(ray, objects[hit.object].half_size_m.xyz);
    const bvec3 entered = bvec3(entry.x >= max(entry.y, entry.z), entry.y > entry.x && entry.y >= entry.z,
                                entry.z > max(entry.x, entry.y));
    const vec3 box = -sign(ray.direction) * vec3(entered);
    const vec3 rectangle = vec3(0.0, 0.0, -sign(ray.direction.z));
    const vec3 sphere = normalize(ray.origin_m + hit.t * ray.direction);
    const bool is_rectangle = hit.object < params.rectangle_count;
    const bool is_box = hit.object < params.rectangle_count + params.box_count;
    return transpose(mat3(object_from_world)) * (is_rectangle ? rectangle : is_box ? box : sphere);
}

// A ray that missed gets some surface, too, whose color is not used: lanes wait for one another anyway.
Surface surface_at(Ray ray, Hit hit) {
    hit.t = hit.t == kMiss ? 0.0 : hit.t;
    return Surface(ray.origin_m + hit.t * ray.direction, normal_at(ray, hit), -normalize(ray.direction),
                   objects[hit.object].kd.rgb, objects[hit.object].ks_alpha);
}

// Which of the surface points a light does not reach.
void find_shadows(Surface surfaces[kTraceSceneRays], vec3 light_m, out bool shadowed[kTraceSceneRays]) {
    Ray rays[kTraceSceneRays];
    Hit hits[kTraceSceneRays];
    EACH_RAY {
        const vec3 lifted_m = surfaces[k].point_m + kShadowBias_m * surfaces[k].normal;
        rays[k] = Ray(lifted_m, light_m - lifted_m);
    }
    trace(rays, hits);
    EACH_RAY shadowed[k] = hits[k].t < 1.0;
}

// The sum over all lights of the paper's Eq. 6.
void shade(Surface surfaces[kTraceSceneRays], out vec3 colors[kTraceSceneRays]) {
    EACH_RAY colors[k] = vec3(0.0);
    for (uint i = 0u; i < params.light_count; ++i) {
        const vec3 light_m = lights[i].position_m.xyz;
        const vec3 intensity = lights[i].intensity.rgb;
        bool shadowed[kTraceSceneRays];
        EACH_RAY shadowed[k] = false;
        if (kShadows != 0u) find_shadows(surfaces, light_m, shadowed);
        EACH_RAY {
            const Surface s = surfaces[k];
            const vec3 light = ward_point_light(s.kd, s.ks_alpha.rgb, s.ks_alpha.a, s.normal, light_m - s.point_m,
                                                intensity, s.to_viewer);
            colors[k] += shadowed[k] ? vec3(0.0) : light;
        }
    }
}

void store(ivec2 pixel, Hit hit, vec3 color, Surface surface) {
    if (any(greaterThanEqual(uvec2(pixel), params.camera.extent))) return;
    const bool missed = hit.t == kMiss;
    imageStore(radiance, pixel, missed ? vec4(0.0) : vec4(color, 1.0));
    imageStore(depth_m, pixel, vec4(missed ? 0.0 : hit.t));
    imageStore(object_id, pixel, uvec4(missed ? 0u : objects[hit.object].id));
    imageStore(normal, pixel, missed ? vec4(0.0) : vec4(surface.normal, 0.0));
    imageStore(kd, pixel, missed ? vec4(0.0) : vec4(surface.kd, 0.0));
    imageStore(ks_alpha, pixel, missed ? vec4(0.0) : surface.ks_alpha);
}

void main() {
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kTraceSceneRays);
    if (any(greaterThanEqual(first, params.camera.extent))) return;
    const vec3 center_m = camera_center_m(params.camera);
    Ray rays[kTraceSceneRays];
    Hit hits[kTraceSceneRays];
    Surface surfaces[kTraceSceneRays];
    vec3 colors[kTraceSceneRays];
    // Scaled to z = 1 in the camera, so that the distance along a ray is the depth.
    EACH_RAY rays[k] = Ray(center_m, to_world_direction(params.camera, unproject(params.camera, first + uvec2(0u, k))));
    trace(rays, hits);
    EACH_RAY surfaces[k] = surface_at(rays[k], hits[k]);
    shade(surfaces, colors);
    EACH_RAY store(ivec2(first + uvec2(0u, k)), hits[k], colors[k], surfaces[k]);
}
