// The light that point lights send to a camera by way of the surfaces it sees: the sum of the paper's Eq. 6.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera.glsl"
#include "lib/ward.glsl"
#include "shared/trace_scene.h"
#include "synthetic/scene.glsl"

layout(local_size_x = 32, local_size_y = 4) in;
layout(constant_id = 0) const uint kShadows = 0u;
layout(rgba32f, binding = 8) uniform image2D radiance;
layout(r32f, binding = 9) uniform readonly image2D depth_m;
layout(r32ui, binding = 10) uniform readonly uimage2D object_id;
layout(rgba32f, binding = 11) uniform readonly image2D normal;
layout(rgba32f, binding = 12) uniform readonly image2D kd;
layout(rgba32f, binding = 13) uniform readonly image2D ks_alpha;
layout(rgba32f, binding = 14) uniform readonly image2D lifted_m;
layout(push_constant) uniform Push { TraceSceneParams params; };

struct Seen {
    vec3 point_m;
    vec3 lifted_m;
    vec3 normal;
    vec3 to_viewer;
    vec3 kd;
    vec4 ks_alpha;
    bool reflects;
};

// Beyond the image's edge nothing is seen.
Seen load(ivec2 pixel, vec3 center_m) {
    const vec3 direction = to_world_direction(params.camera, unproject(params.camera, vec2(pixel)));
    return Seen(center_m + imageLoad(depth_m, pixel).x * direction, imageLoad(lifted_m, pixel).xyz,
                imageLoad(normal, pixel).xyz, -normalize(direction), imageLoad(kd, pixel).rgb,
                imageLoad(ks_alpha, pixel), imageLoad(object_id, pixel).x != 0u);
}

void add_light(SceneLight light, Seen seen[kBundleRays], inout vec3 sums[kBundleRays]) {
    Ray rays[kBundleRays];
    bool blocked[kBundleRays];
    // From the light, so that the rays of a bundle start in one point.
    EACH_RAY {
        rays[k] = Ray(light.position_m.xyz, seen[k].lifted_m - light.position_m.xyz);
        blocked[k] = !seen[k].reflects || dot(seen[k].normal, light.position_m.xyz - seen[k].point_m) <= 0.0;
    }
    if (kShadows != 0u) find_occluded(rays, blocked);
    EACH_RAY {
        const vec3 reflected =
            ward_point_light(seen[k].kd, seen[k].ks_alpha.rgb, seen[k].ks_alpha.a, seen[k].normal,
                             light.position_m.xyz - seen[k].point_m, light.intensity.rgb, seen[k].to_viewer);
        sums[k] += blocked[k] ? vec3(0.0) : reflected;
    }
}

void main() {
    const uvec2 first = gl_GlobalInvocationID.xy * uvec2(1u, kBundleRays);
    if (any(greaterThanEqual(first, params.camera.extent))) return;
    const vec3 center_m = camera_center_m(params.camera);
    Seen seen[kBundleRays];
    vec3 sums[kBundleRays];
    EACH_RAY {
        seen[k] = load(ivec2(first + uvec2(0u, k)), center_m);
        sums[k] = vec3(0.0);
    }
    const uint light_count = scene.light_count;
    for (uint i = 0u; i < light_count; ++i) add_light(lights[i], seen, sums);
    EACH_RAY {
        const ivec2 pixel = ivec2(first + uvec2(0u, k));
        if (uint(pixel.y) < params.camera.extent.y)
            imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(sums[k], 0.0));
    }
}
