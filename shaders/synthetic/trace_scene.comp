#version 460
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
layout(rgba16f, binding = 5) uniform writeonly image2D normal;
layout(push_constant) uniform Push { TraceSceneParams params; };

const float kMiss = 1e30;
const float kShadowBias_m = 1e-4;  // well above what fp32 loses within 10 m, well below a millimetre of depth

struct Ray {
    vec3 origin_m;
    vec3 direction;  // of any length; distances along the ray are multiples of it
};

struct Hit {
    float t;
    uint object;
};

Ray in_object(uint i, Ray ray) {
    const mat4 m = objects[i].object_from_world;
    const vec3 direction = mat3(m) * ray.direction;
    // The slab and plane tests divide by the components: 1e-20 stands for 0, so that no infinity or NaN arises.
    return Ray((m * vec4(ray.origin_m, 1.0)).xyz, mix(direction, vec3(1e-20), equal(direction, vec3(0.0))));
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

Hit nearest_hit(Ray ray) {
    const uint boxes = params.rectangle_count;
    const uint spheres = boxes + params.box_count;
    const uint end = spheres + params.sphere_count;
    Hit hit = Hit(kMiss, 0u);
    for (uint i = 0u; i < boxes; ++i) keep_nearer(hit, hit_rectangle(in_object(i, ray), objects[i].half_size_m.xy), i);
    for (uint i = boxes; i < spheres; ++i) keep_nearer(hit, hit_box(in_object(i, ray), objects[i].half_size_m.xyz), i);
    for (uint i = spheres; i < end; ++i) keep_nearer(hit, hit_sphere(in_object(i, ray), objects[i].half_size_m.x), i);
    return hit;
}

// The unit normal at a hit, world, towards the viewer.
vec3 normal_at(Ray world_ray, Hit hit) {
    const Ray ray = in_object(hit.object, world_ray);
    const vec3 entry = slab_entries(ray, objects[hit.object].half_size_m.xyz);
    const bvec3 entered = bvec3(entry.x >= max(entry.y, entry.z), entry.y > entry.x && entry.y >= entry.z,
                                entry.z > max(entry.x, entry.y));
    const vec3 box = -sign(ray.direction) * vec3(entered);
    const vec3 rectangle = vec3(0.0, 0.0, -sign(ray.direction.z));
    const vec3 sphere = normalize(ray.origin_m + hit.t * ray.direction);
    const bool is_rectangle = hit.object < params.rectangle_count;
    const bool is_box = hit.object < params.rectangle_count + params.box_count;
    const vec3 local = is_rectangle ? rectangle : is_box ? box : sphere;
    return transpose(mat3(objects[hit.object].object_from_world)) * local;
}

// The sum over all lights of the paper's Eq. 6.
vec3 shade(Ray ray, Hit hit, vec3 surface_normal) {
    const TraceObject object = objects[hit.object];
    const vec3 point_m = ray.origin_m + hit.t * ray.direction;
    const vec3 to_viewer = -normalize(ray.direction);
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < params.light_count; ++i) {
        const vec3 offset_m = lights[i].position_m.xyz - point_m;
        vec3 light = ward_point_light(object.kd.rgb, object.ks_alpha.rgb, object.ks_alpha.a, surface_normal, offset_m,
                                      lights[i].intensity.rgb, to_viewer);
        if (kShadows != 0u) {
            const vec3 lifted_m = point_m + kShadowBias_m * surface_normal;
            light *= nearest_hit(Ray(lifted_m, lights[i].position_m.xyz - lifted_m)).t < 1.0 ? 0.0 : 1.0;
        }
        sum += light;
    }
    return sum;
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.camera.extent))) return;
    // Scaled to z = 1 in the camera, so that the distance along the ray is the depth.
    const Ray ray =
        Ray(camera_center_m(params.camera), to_world_direction(params.camera, unproject(params.camera, pixel)));
    const Hit hit = nearest_hit(ray);
    const bool missed = hit.t == kMiss;
    vec4 color = vec4(0.0);
    vec4 direction = vec4(0.0);
    uint id = 0u;
    if (!missed) {
        direction.xyz = normal_at(ray, hit);
        color = vec4(shade(ray, hit, direction.xyz), 1.0);
        id = objects[hit.object].id;
    }
    const ivec2 at = ivec2(pixel);
    imageStore(radiance, at, color);
    imageStore(depth_m, at, vec4(missed ? 0.0 : hit.t));
    imageStore(object_id, at, uvec4(id));
    imageStore(normal, at, direction);
}
