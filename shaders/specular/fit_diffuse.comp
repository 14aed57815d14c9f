#version 460
#extension GL_GOOGLE_include_directive : require
// The diffuse albedo of whole segments, by least squares: one kd that makes the colours of all voxels under their
// light, with the highlights of the material that was fitted. One workgroup per segment: each invocation sums up some
// of its voxels, then one adds up what all have, always in the same order. Clipped channels are left out.
#include "lib/brdf/ward.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/records/gathered_light.glsl"
#include "lib/records/reflectance.glsl"
#include "shared/specular/ward_fit.h"

layout(local_size_x = kFitGroup) in;
layout(std140, binding = 0) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(std430, binding = 1) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 2) readonly buffer Voxels { FitVoxel voxels[]; };
layout(std430, binding = 3) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 4) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 5) readonly buffer Weights { float weights[]; };
layout(std430, binding = 6) readonly buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 11) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(std430, binding = 16) buffer Fits { WardFit fits[]; };
layout(push_constant) uniform Push { FitParams params; };
#include "lib/lighting/fit_lights.glsl"
#include "lib/records/record_colors.glsl"
#include "lib/records/record_directions.glsl"

shared vec3 diffuse_of[kFitGroup];
shared vec3 light2_of[kFitGroup];

// What lights and all around do to a voxel, over pi.
vec3 irradiance(GatheredLight gathered, vec3 point_m, vec3 normal, uvec2 reached, uint count) {
    vec3 sum = gathered_irradiance(gathered, header.ambient.rgb);
    for (uint i = 0u; i < count; ++i) sum += fit_light(i, point_m, normal, reached).received;
    return sum;
}

// The lobes of all lights, as ks multiplies them but for ward_scale().
vec3 lobes(vec3 point_m, vec3 normal, uvec2 reached, uint count, WardShape shape, vec3 to_viewer) {
    const float cosine = max(dot(to_viewer, normal), kFitLeastCosine);
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < count; ++i) {
        const FitLight light = fit_light(i, point_m, normal, reached);
        sum += light.gloss * ward_falloff(shape, tan2_of_half(light, to_viewer, cosine));
    }
    return sum * ward_viewer_part(cosine);
}

void main() {
    const uint segment = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    const uint label = batch[1u + segment];
    const bool known = label < params.labels;
    const WardFit fit = fits[known ? label : 0u];
    // What has been fitted often hardly changes.
    const bool often = fit.estimates > kFitDiffuseEvery;
    const bool due = known && (!often || fit.estimates % kFitDiffuseEvery == 0u);
    // Of a count that is a uniform alone, lavapipe (Mesa 22.3) compiles the shader anew in each frame, and leaks it.
    const uint count = due ? header.count : 0u;
    const vec3 ks_scaled = fit.ks_alpha.rgb * ward_scale(fit.ks_alpha.w);
    vec3 diffuse = vec3(0.0), light2 = vec3(0.0);
    for (uint slot = lane; due && slot < kSegmentSamples; slot += kFitGroup) {
        const FitVoxel voxel = voxels[segment * kSegmentSamples + slot];
        if (voxel.record == kNoRecord) continue;
        const VoxelRecord record = records[voxel.record];
        const vec3 point_m = surface_point_m(record, params.records, params.edge_shift);
        const vec3 normal = surface_normal(record);
        const uvec2 reached = visibility[voxel.record];
        const WardShape shape = ward_shape_blurred(fit.ks_alpha.w, voxel.blur2);
        vec3 rest = vec3(0.0), weight_sum = vec3(0.0);
        for (uint k = 0u; k < kMaxObservations; ++k) {
            const float weight = weights[(segment * kMaxObservations + k) * kSegmentSamples + slot];
            if (weight == 0.0) continue;
            const uint word = load_direction(params.records.chunk_shift, voxel.record, k);
            const vec3 channels = weight * vec3(not(observation_clipped(word)));
            const vec3 color = unpack_shared_exponent(load_color(params.records.chunk_shift, voxel.record, k));
            const vec3 glossy = ks_scaled * lobes(point_m, normal, reached, count, shape, observation_direction(word));
            rest += channels * (color - glossy);
            weight_sum += channels;
        }
        const GatheredLight gathered = unpack_gathered(voxel.incident);
        const vec3 light = irradiance(gathered, point_m, normal, reached, count);
        diffuse += light * (rest - weight_sum * gathered_gloss(gathered, header.ambient.rgb, fit.ks_alpha.rgb));
        light2 += light * light * weight_sum;
    }
    diffuse_of[lane] = diffuse;
    light2_of[lane] = light2;
    barrier();
    if (lane != 0u || !due) return;
    for (uint i = 1u; i < kFitGroup; ++i) {
        diffuse += diffuse_of[i];
        light2 += light2_of[i];
    }
    const float kept = fit.estimates > 1u ? pow(params.memory, often ? float(kFitDiffuseEvery) : 1.0) : 0.0;
    fits[label].diffuse = vec4(diffuse + kept * fit.diffuse.rgb, 0.0);
    fits[label].light2 = vec4(light2 + kept * fit.light2.rgb, 0.0);
}
