// What a camera sees of a synthetic scene at each pixel: the first surface, or lamp, behind its centre.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera/camera.glsl"
#include "lib/lighting/lamp_emission.glsl"
#include "scenes/surface.glsl"
#include "shared/scenes/trace_scene.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(rgba32f, binding = 8) uniform writeonly image2D radiance;  // of lamps; a = 1 where anything is seen
layout(r32f, binding = 9) uniform writeonly image2D depth_m;
layout(r32ui, binding = 10) uniform writeonly uimage2D object_id;
layout(rgba32f, binding = 11) uniform writeonly image2D normal;
layout(rgba32f, binding = 12) uniform writeonly image2D kd;
layout(rgba32f, binding = 13) uniform writeonly image2D ks_alpha;
layout(std430, binding = 14) writeonly buffer Lifted { vec4 lifted_m[]; };  // where rays that leave the surface start
layout(push_constant) uniform Push { TraceSceneParams params; };

// Lamps hide what is behind them: `lamp` is the one that the ray meets at hit.t instead of the surface that it hit.
void store(ivec2 pixel, Ray ray, Hit hit, uint lamp, Surface surface) {
    if (any(greaterThanEqual(uvec2(pixel), params.camera.extent))) return;
    const bool seen = hit.t < kMiss;
    const bool reflects = seen && lamp == kNothingHit;
    imageStore(depth_m, pixel, vec4(seen ? hit.t : 0.0));
    imageStore(object_id, pixel, uvec4(reflects ? surface.object_id : 0u));
    imageStore(kd, pixel, reflects ? vec4(surface.kd, 0.0) : vec4(0.0));
    imageStore(ks_alpha, pixel, reflects ? surface.ks_alpha : vec4(0.0));
    lifted_m[uint(pixel.y) * params.camera.extent.x + uint(pixel.x)] =
        reflects ? vec4(surface.lifted_m, 0.0) : vec4(0.0);
    vec3 facing = surface.normal, emitted = vec3(0.0);
    if (lamp != kNothingHit) {
        facing = normalize(ray.origin_m + hit.t * ray.direction - lights[lamp].light.position_m.xyz);
        emitted = lights[lamp].emitted.rgb * emission_from(lights[lamp].light, normalize(ray.direction));
    }
    imageStore(normal, pixel, seen ? vec4(facing, 0.0) : vec4(0.0));
    imageStore(radiance, pixel, vec4(emitted, seen ? 1.0 : 0.0));
}

void main() {
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kBundleRays);
    if (any(greaterThanEqual(first, params.camera.extent))) return;
    const vec3 center_m = camera_center_m(params.camera);
    Ray rays[kBundleRays];
    Hit hits[kBundleRays];
    Surface surfaces[kBundleRays];
    uint lamps[kBundleRays];
    // Scaled to z = 1 in the camera, so that the distance along a ray is the depth.
    EACH_RAY rays[k] = Ray(center_m, to_world_direction(params.camera, unproject(params.camera, first + uvec2(0u, k))));
    trace(rays, hits);
    EACH_RAY surfaces[k] = surface_at(rays[k], hits[k]);
    hit_lamps(rays, hits, lamps);
    EACH_RAY store(ivec2(first + uvec2(0u, k)), rays[k], hits[k], lamps[k], surfaces[k]);
}
