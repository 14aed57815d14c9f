#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Normal equations of the Ward fit. One workgroup per segment and block of alphas: each invocation sums up some of the
// segment's voxels, then one adds up what all have, always in the same order. The voxel's diffuse part, whose
// irradiance does not depend on the view, drops out with the mean over its observations.
#include "lib/fit_alphas.glsl"
#include "lib/reflectance.glsl"
#include "lib/voxel_chunks.glsl"
#include "shared/ward_fit.h"

layout(local_size_x = kFitGroup) in;
layout(std140, binding = 0) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(std430, binding = 1) readonly buffer Voxels { FitVoxel voxels[]; };
layout(std430, binding = 2) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 3) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 4) readonly buffer Weights { uint weights[]; };  // lib/fit_weights.glsl
layout(std430, binding = 5) readonly buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 10) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(std430, binding = 15) writeonly buffer Sums { FitSums sums[]; };   // by segment, then by alpha
layout(std430, binding = 16) writeonly buffer Totals { vec4 totals[]; };  // by segment: rgb colours, w weights
layout(push_constant) uniform Push { FitParams params; };
#include "lib/fit_lights.glsl"
#include "lib/fit_weights.glsl"
#include "lib/record_colors.glsl"
#include "lib/record_directions.glsl"

const uint kAlphas = kFitAlphasPerGroup;
const uint kSumRows = 6u * kAlphas + 4u;
const uint kRows = kSumRows + kAlphas;

const float kSeenLobe = 0.5;  // a view this near to the peak tells it; from flanks alone it is a guess

shared float partial[kRows][kFitGroup + 1u];

vec3 lobe2[kAlphas];
vec3 product[kAlphas];
float seen[kAlphas];  // voxels of which a view came near a mirrored light
float peak[kAlphas];  // the largest lobe of a voxel, 1 for a view at a mirrored light
vec4 total;           // rgb: squared colours; w: how many, by channel

// Of the lobes of a voxel, which are blurred: what tan^2 is multiplied by in an exponent to the base of 2, and the
// peak.
vec2 blurred[kAlphas];

void blur_lobes(uint first, float blur2) {
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) {
        const float alpha = fit_alpha(float(first + a)), inverse = 1.0 / (alpha * alpha + blur2);
        blurred[a] = vec2(-kFitLog2E * inverse, alpha * alpha * inverse);
    }
}

// exp(-tan^2 / alpha^2) for each alpha, blurred: as wide as that of a rougher material, and with the same integral.
void add_lobes(inout vec3 lobes[kAlphas], vec3 gloss, float tan2) {
    const float lit = any(greaterThan(gloss, vec3(0.0))) ? 1.0 : 0.0;
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) {
        const float lobe = blurred[a].y * exp2(max(tan2 * blurred[a].x, kFitLeastExponent));
        lobes[a] += gloss * lobe;
        peak[a] = max(peak[a], lit * lobe);
    }
}

void add_voxel(uint segment, uint slot, uint record) {
    const VoxelRecord known = records[record];
    const vec3 normal = surface_normal(known);
    const vec3 point_m = surface_point_m(known, params.records, params.edge_shift);
    const uvec2 reached = visibility[record];
    const uint first = segment * kMaxObservations * kSegmentSamples + slot;

    vec3 weight_sum = vec3(1e-20), color_sum = vec3(0.0);
    for (uint quad = 0u; quad < kRecordQuads; ++quad) {
        const uvec4 color_words = load_colors(params.records.chunk_shift, record, quad);
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            const uint k = min(4u * quad + i, kMaxObservations - 1u);
            const uint weight = 4u * quad + i < kMaxObservations ? weights[first + k * kSegmentSamples] : 0u;
            const vec3 channels = fit_channel_weights(weight);
            weight_sum += channels;
            color_sum += channels * (weight != 0u ? unpack_shared_exponent(color_words[i]) : vec3(0.0));
        }
    }
    const vec3 mean = color_sum / weight_sum;

    vec3 sum[kAlphas], sum2[kAlphas], sum_color[kAlphas];
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) {
        sum[a] = sum2[a] = sum_color[a] = vec3(0.0);
        peak[a] = 0.0;
    }
    for (uint k = 0u; k < kMaxObservations; ++k) {
        const uint weight = weights[first + k * kSegmentSamples];
        if (weight == 0u) continue;
        const uint word = load_direction(params.records.chunk_shift, record, k);
        const vec3 off = unpack_shared_exponent(load_color(params.records.chunk_shift, record, k)) - mean;
        const vec3 to_viewer = observation_direction(word);
        const float cosine = max(dot(to_viewer, normal), kFitLeastCosine);
        const vec3 channels = fit_channel_weights(weight);
        vec3 lobes[kAlphas];
        [[unroll]] for (uint a = 0u; a < kAlphas; ++a) lobes[a] = vec3(0.0);
        const float bend = inversesqrt(cosine);
        for (uint i = 0u; i < header.count; ++i) {
            const FitLight light = fit_light(i, point_m, normal, reached);
            add_lobes(lobes, light.gloss * bend, tan2_of_half(light, to_viewer, cosine));
        }
        [[unroll]] for (uint a = 0u; a < kAlphas; ++a) {
            const vec3 weighted = channels * lobes[a];
            sum[a] += weighted;
            sum2[a] += weighted * lobes[a];
            sum_color[a] += weighted * off;
        }
        total += vec4(channels * off * off, dot(vec3(greaterThan(channels, vec3(0.0))), vec3(1.0)));
    }
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) {
        lobe2[a] += max(sum2[a] - sum[a] * sum[a] / weight_sum, 0.0);
        product[a] += sum_color[a];
        seen[a] += min(peak[a] * (1.0 / kSeenLobe), 1.0);
    }
}

void main() {
    const uint segment = gl_WorkGroupID.x, block = gl_WorkGroupID.y, lane = gl_LocalInvocationIndex;
    total = vec4(0.0);
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) {
        lobe2[a] = product[a] = vec3(0.0);
        seen[a] = 0.0;
    }
    for (uint slot = lane; slot < kSegmentSamples; slot += kFitGroup) {
        const FitVoxel voxel = voxels[segment * kSegmentSamples + slot];
        if (voxel.record == kNoRecord) continue;
        blur_lobes(block * kAlphas, voxel.blur2);
        add_voxel(segment, slot, voxel.record);
    }
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) {
        [[unroll]] for (uint c = 0u; c < 3u; ++c) {
            partial[6u * a + c][lane] = lobe2[a][c];
            partial[6u * a + 3u + c][lane] = product[a][c];
        }
        partial[kSumRows + a][lane] = seen[a];
    }
    [[unroll]] for (uint c = 0u; c < 4u; ++c) partial[6u * kAlphas + c][lane] = total[c];
    barrier();
    if (lane < kRows) {
        float sum = 0.0;
        for (uint i = 0u; i < kFitGroup; ++i) sum += partial[lane][i];
        partial[lane][0] = sum;
    }
    barrier();
    if (lane < kAlphas) {
        const uint row = 6u * lane;
        sums[segment * kFitAlphas + block * kAlphas + lane] =
            FitSums(vec4(partial[row][0], partial[row + 1u][0], partial[row + 2u][0], partial[kSumRows + lane][0]),
                    vec4(partial[row + 3u][0], partial[row + 4u][0], partial[row + 5u][0], 0.0));
    }
    const uint row = 6u * kAlphas;
    if (lane == 0u && block == 0u)
        totals[segment] = vec4(partial[row][0], partial[row + 1u][0], partial[row + 2u][0], partial[row + 3u][0]);
}
