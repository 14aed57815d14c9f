// The light that point lights send to a camera by way of the surfaces it sees: the sum of the paper's Eq. 6.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/brdf/ward.glsl"
#include "lib/camera/camera.glsl"
#include "lib/lighting/lamp_emission.glsl"
#include "scenes/scene.glsl"
#include "shared/scenes/trace_scene.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(constant_id = 0) const uint kShadows = 0u;
layout(rgba32f, binding = 8) uniform image2D radiance;
layout(binding = 9) uniform sampler2D depth_m;
layout(binding = 10) uniform usampler2D object_id;
layout(binding = 11) uniform sampler2D normal;
layout(binding = 12) uniform sampler2D kd;
layout(binding = 13) uniform sampler2D ks_alpha;
layout(std430, binding = 14) readonly buffer Lifted { vec4 lifted_m[]; };
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
    return Seen(center_m + texelFetch(depth_m, pixel, 0).x * direction,
                lifted_m[min(uint(pixel.y), params.camera.extent.y - 1u) * params.camera.extent.x + uint(pixel.x)].xyz,
                texelFetch(normal, pixel, 0).xyz, -normalize(direction), texelFetch(kd, pixel, 0).rgb,
                texelFetch(ks_alpha, pixel, 0), texelFetch(object_id, pixel, 0).x != 0u);
}

void add_light(PointLight light, Seen seen[kBundleRays], inout vec3 sums[kBundleRays]) {
    Ray rays[kBundleRays];
    bool blocked[kBundleRays];
    // From the light, so that the rays of a bundle start in one point.
    EACH_RAY {
        rays[k] = Ray(light.position_m.xyz, seen[k].lifted_m - light.position_m.xyz);
        blocked[k] = !seen[k].reflects || dot(seen[k].normal, light.position_m.xyz - seen[k].point_m) <= 0.0;
    }
    if (kShadows != 0u) find_occluded(rays, blocked);
    EACH_RAY {
        const vec3 offset_m = light.position_m.xyz - seen[k].point_m;
        const vec3 reflected =
            ward_point_light(seen[k].kd, seen[k].ks_alpha.rgb, seen[k].ks_alpha.a, seen[k].normal, offset_m,
                             intensity_from(light, normalize(offset_m)), seen[k].to_viewer);
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
    for (uint i = 0u; i < light_count; ++i) add_light(lights[i].light, seen, sums);
    EACH_RAY {
        const ivec2 pixel = ivec2(first + uvec2(0u, k));
        if (uint(pixel.y) < params.camera.extent.y)
            imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(sums[k], 0.0));
    }
}
