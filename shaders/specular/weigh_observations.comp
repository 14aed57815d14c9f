#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// One invocation per voxel of a segment: how much each of its observations counts for the fit, as an inverse variance.
// What is far off the segment's estimate so far, with the voxel's own diffuse part, counts less (Geman and McClure).
#include "lib/fit_alphas.glsl"
#include "lib/reflectance.glsl"
#include "lib/voxel_chunks.glsl"
#include "shared/ward_fit.h"

layout(local_size_x = kFitGroup) in;
layout(std140, binding = 0) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(std430, binding = 1) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 2) readonly buffer Voxels { uint voxels[]; };
layout(std430, binding = 3) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 4) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 5) readonly buffer Fits { WardFit fits[]; };
layout(std430, binding = 6) readonly buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 11) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(std430, binding = 16) writeonly buffer Weights { float weights[]; };  // by segment, observation and voxel
layout(push_constant) uniform Push { FitParams params; };
#include "lib/fit_lights.glsl"
#include "lib/record_colors.glsl"
#include "lib/record_directions.glsl"

const float kNoise = 0.004;         // of an observed colour, linear: 8-bit sRGB's steps in dark tones
const float kRelativeNoise = 0.05;  // and that of bright ones: normals, lights and colours are estimates
const float kRobustScale = 2.0;     // deviations at which a weight is a quarter
const float kLeastDeviation = 0.3;  // where everything fits, weights would take what does not for noise
// Of an estimate that tells outliers: to one without a highlight, the first view of it would be one.
const float kTrustedConfidence = 0.5;
const uint kRobustSteps = 2u;

uint direction_word[kMaxObservations];
vec3 direction_of[kMaxObservations];
float viewer_cosine[kMaxObservations];
vec3 highlight[kMaxObservations];
vec3 rest[kMaxObservations];    // the colour without its highlight
float trust[kMaxObservations];  // inverse variance; 0 where it does not count
float robust[kMaxObservations];

vec3 unclipped(uint k) { return vec3(not(observation_clipped(direction_word[k]))); }

void unpack_directions(uint record, vec3 normal) {
    [[unroll]] for (uint quad = 0u; quad < kRecordQuads; ++quad) {
        const uvec4 words = load_directions(params.records.chunk_shift, record, quad);
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            const uint k = 4u * quad + i;
            if (k >= kMaxObservations) continue;
            direction_word[k] = words[i];
            direction_of[k] = observation_direction(words[i]);
            viewer_cosine[k] = dot(direction_of[k], normal);
            highlight[k] = vec3(0.0);
        }
    }
}

void add_highlights(vec3 point_m, vec3 normal, uvec2 reached, float alpha, uint count) {
    const float exponent_scale = -kFitLog2E / (alpha * alpha);
    for (uint i = 0u; i < count; ++i) {
        const FitLight light = fit_light(i, point_m, normal, reached);
        [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
            const float tan2 = tan2_of_half(light, direction_of[k], max(viewer_cosine[k], kFitLeastCosine));
            highlight[k] += light.gloss * exp2(max(exponent_scale * tan2, kFitLeastExponent));
        }
    }
}

void take_highlights(uint record, uint count, vec3 ks_scale) {
    [[unroll]] for (uint quad = 0u; quad < kRecordQuads; ++quad) {
        const uvec4 words = load_colors(params.records.chunk_shift, record, quad);
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            const uint k = 4u * quad + i;
            if (k >= kMaxObservations) continue;
            const vec3 rgb = unpack_shared_exponent(words[i]);
            const float noise = kNoise + kRelativeNoise * dot(rgb, vec3(1.0 / 3.0));
            const bool counts = k < count && viewer_cosine[k] >= kFitLeastCosine;
            trust[k] = counts ? 1.0 / (noise * noise) : 0.0;
            robust[k] = 1.0;
            rest[k] = rgb - highlight[k] * ks_scale * inversesqrt(max(viewer_cosine[k], kFitLeastCosine));
        }
    }
}

// Weights about the mean of the rest, with the deviation of the estimate so far.
void reweight(float deviation) {
    const float inverse_scale2 = 1.0 / (kRobustScale * kRobustScale * deviation * deviation);
    for (uint step = 0u; step < kRobustSteps; ++step) {
        vec3 sum = vec3(0.0), weight_sum = vec3(1e-20);
        [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
            const vec3 weight = trust[k] * robust[k] * unclipped(k);
            sum += weight * rest[k];
            weight_sum += weight;
        }
        const vec3 mean = sum / weight_sum;
        [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
            const vec3 off = (rest[k] - mean) * unclipped(k);
            const float channels = max(dot(unclipped(k), vec3(1.0)), 1.0);
            const float share = 1.0 / (1.0 + dot(off, off) * trust[k] * inverse_scale2 / channels);
            robust[k] = share * share;
        }
    }
}

void main() {
    const uint segment = gl_GlobalInvocationID.x / kSegmentSamples, slot = gl_GlobalInvocationID.x % kSegmentSamples;
    const uint record = voxels[gl_GlobalInvocationID.x];
    if (record == kNoRecord) return;
    const VoxelRecord known = records[record];
    const vec3 normal = surface_normal(known);
    const WardFit fit = fits[batch[1u + segment]];
    const bool estimated = fit.estimates > 0u;
    const float alpha = estimated ? fit.ks_alpha.w : 1.0;
    unpack_directions(record, normal);
    add_highlights(surface_point_m(known, params.records, params.edge_shift), normal, visibility[record], alpha,
                   estimated ? header.count : 0u);
    take_highlights(record, observation_count(known), estimated ? fit.ks_alpha.rgb * lobe_scale(alpha) : vec3(0.0));
    if (fit.confidence >= kTrustedConfidence) reweight(max(fit.deviation, kLeastDeviation));
    [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k)
        weights[(segment * kMaxObservations + k) * kSegmentSamples + slot] = trust[k] * robust[k];
}
