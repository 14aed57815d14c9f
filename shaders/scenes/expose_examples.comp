#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per scene: the exposure at which the 95 % quantile of what the camera sees is as bright as the scene
// asks for. The segment is not alone in the picture: things as near are made of the scene's other materials.
#include "scenes/example_light.glsl"

layout(local_size_x = kExampleVoxels) in;
layout(std430, binding = 6) readonly buffer Irradiance { vec4 irradiance[]; };
layout(std430, binding = 7) writeonly buffer Exposures { float exposures[]; };

const float kQuantile = 0.95;
const float kNotSeen = 3.0e38;

shared float levels[kExposeSamples];
shared uint seen;

float level_seen(uint scene, uint voxel, uint sample_index) {
    const uint view = sample_index * scenes[scene].views / kExposeViews;
    const vec3 to_viewer = normalize(views[scene * kExampleViews + view].xyz - voxels[voxel].point_m.xyz);
    if (dot(voxels[voxel].normal.xyz, to_viewer) < params.min_cosine) return kNotSeen;
    const vec2 shift = random_numbers(voxel_stream(voxel), view, kReflectedShift).zw;
    const vec3 radiance =
        radiance_to(scene, voxel, sample_index % kExampleMaterials, irradiance[voxel].rgb, to_viewer, shift);
    return max(max(radiance.r, radiance.g), radiance.b);
}

void main() {
    const uint scene = gl_WorkGroupID.x, voxel = scene * kExampleVoxels + gl_LocalInvocationIndex;
    if (gl_LocalInvocationIndex == 0u) {
        seen = 0u;
        exposures[scene] = 0.0;
    }
    barrier();
    for (uint i = 0u; i < kExposeViews; ++i) {
        const float level = level_seen(scene, voxel, i);
        levels[gl_LocalInvocationIndex * kExposeViews + i] = level;
        if (level != kNotSeen) atomicAdd(seen, 1u);
    }
    barrier();
    const uint wanted = uint(kQuantile * float(seen));  // how many are darker
    for (uint i = 0u; i < kExposeViews && seen > 0u; ++i) {
        const uint own = gl_LocalInvocationIndex * kExposeViews + i;
        uint rank = 0u;
        for (uint other = 0u; other < kExposeSamples; ++other) {
            rank += levels[other] < levels[own] || (levels[other] == levels[own] && other < own) ? 1u : 0u;
        }
        if (rank == wanted) exposures[scene] = scenes[scene].sky.w / max(levels[own], 1e-12);
    }
}
