// What a camera sees of the voxels of example scenes (shared/scenes/example_scenes.h). Bindings 0 to 6; push constants.
#ifndef PATINA_SYNTHETIC_EXAMPLE_LIGHT_GLSL
#define PATINA_SYNTHETIC_EXAMPLE_LIGHT_GLSL
#include "lib/brdf/ward.glsl"
#include "lib/math/random.glsl"
#include "lib/math/sampling.glsl"
#include "shared/scenes/example_scenes.h"

layout(std430, binding = 0) readonly buffer Scenes { ExampleScene scenes[]; };
layout(std430, binding = 1) readonly buffer Lamps { PointLight lamps[]; };  // kExampleLamps per scene, and so on
layout(std430, binding = 2) readonly buffer Windows { ExampleWindow windows[]; };
layout(std430, binding = 3) readonly buffer Materials { WardMaterial materials[]; };
layout(std430, binding = 4) readonly buffer Voxels { ExampleVoxel voxels[]; };
layout(std430, binding = 5) readonly buffer Views { vec4 views[]; };  // camera centres, metres
layout(push_constant) uniform Push { ExampleParams params; };

// What random numbers are used for: the index of a stream's numbers is the view.
const uint kIrradianceShift = 0u, kReflectedShift = 1u, kHidden = 2u, kNoise = 3u;

// Of a voxel of the batch: its own among all voxels of the seed.
uvec2 voxel_stream(uint voxel) { return random_stream(params.seed, 0u, params.first * kExampleVoxels + voxel); }

// Points of the unit square that fill it evenly.
vec2 even_point(vec2 shift, uint index) { return fract(shift + vec2(index * kR2Steps >> 8u) * (1.0 / 16777216.0)); }

vec3 radiance_from(uint scene, vec3 direction) {
    vec3 sum = mix(scenes[scene].ground.rgb, scenes[scene].sky.rgb, 0.5 - 0.5 * direction.y);
    for (uint i = 0u; i < scenes[scene].windows; ++i) {
        const ExampleWindow window = windows[scene * kExampleWindows + i];
        sum += window.radiance.rgb *
               smoothstep(window.direction.w, window.radiance.w, dot(direction, window.direction.xyz));
    }
    return sum;
}

// Over pi, of the light from afar.
vec3 irradiance_at(uint scene, vec3 normal, vec2 shift) {
    const mat3 basis = basis_around(normal);
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < kIrradianceRays; ++i) {
        sum += radiance_from(scene, basis * sample_cosine(even_point(shift, i)));
    }
    return sum / float(kIrradianceRays);
}

// The Ward lobe's reflection of the light from afar, without its albedo.
vec3 reflected_from_afar(uint scene, float alpha, vec3 normal, vec3 to_viewer, vec2 shift) {
    const uint rays = scenes[scene].windows > 0u ? kReflectedRays : kReflectedRaysSky;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < rays; ++i) {
        const vec3 to_light = sample_ward(alpha, normal, to_viewer, even_point(shift, i));
        const float cosine = dot(normal, to_light);
        const float density = ward_density(alpha, normal, to_light, to_viewer);
        const float weight =
            cosine > 0.0 && density > 0.0 ? ward_lobe(alpha, normal, to_light, to_viewer) * cosine / density : 0.0;
        sum += weight * radiance_from(scene, to_light);
    }
    return sum / float(rays);
}

// Radiance from a voxel, made of a material of its scene, towards a viewer.
vec3 radiance_to(uint scene, uint voxel, uint material, vec3 irradiance, vec3 to_viewer, vec2 shift) {
    const ExampleVoxel at = voxels[voxel];
    const WardMaterial made_of = materials[scene * kExampleMaterials + material];
    const vec3 kd = made_of.kd_weight.rgb * at.point_m.w, ks = made_of.ks_alpha.rgb;
    const float alpha = made_of.ks_alpha.w;
    vec3 sum = kd * irradiance + ks * reflected_from_afar(scene, alpha, at.normal.xyz, to_viewer, shift);
    for (uint i = 0u; i < scenes[scene].lamps; ++i) {
        const PointLight lamp = lamps[scene * kExampleLamps + i];
        const vec3 light = ward_point_light(kd, ks, alpha, at.normal.xyz, lamp.position_m.xyz - at.point_m.xyz,
                                            lamp.intensity.rgb, to_viewer);
        sum += (at.shadow >> i & 1u) != 0u ? vec3(0.0) : light;
    }
    return sum;
}

#endif
