// What a camera sees of a synthetic scene at each pixel: the first surface, or lamp, behind its centre.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "shared/trace_scene.h"
#include "synthetic/surface.glsl"

layout(local_size_x = 32, local_size_y = 4) in;
layout(rgba32f, binding = 8) uniform writeonly image2D radiance;  // of lamps; a = 1 where anything is seen
layout(r32f, binding = 9) uniform writeonly image2D depth_m;
layout(r32ui, binding = 10) uniform writeonly uimage2D object_id;
layout(rgba32f, binding = 11) uniform writeonly image2D normal;
layout(rgba32f, binding = 12) uniform writeonly image2D kd;
layout(rgba32f, binding = 13) uniform writeonly image2D ks_alpha;
layout(rgba32f, binding = 14) uniform writeonly image2D lifted_m;  // where rays that leave the surface start
layout(push_constant) uniform Push { TraceSceneParams params; };

void store(ivec2 pixel, Ray ray, Hit hit) {
    if (any(greaterThanEqual(uvec2(pixel), params.camera.extent))) return;
    const Surface surface = surface_at(ray, hit);
    float depth = hit.t;
    const uint lamp = hit_lamps(ray, depth);
    const bool on_lamp = lamp != kNothingHit;
    const bool seen = depth < kMiss;
    const bool reflects = seen && !on_lamp;
    const SceneLight light = lights[on_lamp ? lamp : 0u];
    const vec3 point_m = ray.origin_m + depth * ray.direction;
    const vec3 facing = on_lamp ? normalize(point_m - light.position_m.xyz) : surface.normal;
    imageStore(radiance, pixel, on_lamp ? vec4(light.emitted.rgb, 1.0) : vec4(0.0, 0.0, 0.0, seen ? 1.0 : 0.0));
    imageStore(depth_m, pixel, vec4(seen ? depth : 0.0));
    imageStore(object_id, pixel, uvec4(reflects ? surface.object_id : 0u));
    imageStore(normal, pixel, seen ? vec4(facing, 0.0) : vec4(0.0));
    imageStore(kd, pixel, reflects ? vec4(surface.kd, 0.0) : vec4(0.0));
    imageStore(ks_alpha, pixel, reflects ? surface.ks_alpha : vec4(0.0));
    imageStore(lifted_m, pixel, reflects ? vec4(surface.lifted_m, 0.0) : vec4(0.0));
}

void main() {
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kBundleRays);
    if (any(greaterThanEqual(first, params.camera.extent))) return;
    const vec3 center_m = camera_center_m(params.camera);
    Ray rays[kBundleRays];
    Hit hits[kBundleRays];
    // Scaled to z = 1 in the camera, so that the distance along a ray is the depth.
    EACH_RAY rays[k] = Ray(center_m, to_world_direction(params.camera, unproject(params.camera, first + uvec2(0u, k))));
    trace(rays, hits);
    EACH_RAY store(ivec2(first + uvec2(0u, k)), rays[k], hits[k]);
}
