#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// One invocation per voxel of a segment: how much each of its observations counts for the fit, as an inverse variance.
// What is far off the segment's estimate so far, with the voxel's own diffuse part, counts less (Geman and McClure),
// but for clipped channels: they are at least as bright as they were recorded, and count where that estimate is darker.
#include "lib/brdf/fit_alphas.glsl"
#include "lib/brdf/ward.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/math/mean.glsl"
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
layout(std430, binding = 5) readonly buffer Fits { WardFit fits[]; };
layout(std430, binding = 6) readonly buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 11) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(std430, binding = 16) writeonly buffer Weights { float weights[]; };  // by segment, observation and voxel
layout(push_constant) uniform Push { FitParams params; };
#include "lib/lighting/fit_lights.glsl"
#include "lib/records/record_colors.glsl"
#include "lib/records/record_directions.glsl"

const float kNoise = 0.004;         // of an observed colour, linear: 8-bit sRGB's steps in dark tones
const float kRelativeNoise = 0.05;  // and that of bright ones: lights and colours are estimates
const float kHighlightError = 0.3;  // what of a predicted highlight may be wrong, as normals are estimates
const float kRobustScale = 2.0;     // deviations at which a weight is a quarter
// Where everything fits, ever more of a highlight would be taken for outliers.
const float kLeastOutlierDeviation = 1.0;
// Of an estimate that tells outliers: to one without a highlight, the first view of it would be one.
const float kTrustedConfidence = 0.5;
const float kTrustedKs = 0.01;
const uint kRobustSteps = 2u;
const float kInfinite = 1e30;

uint direction_word[kMaxObservations];
vec3 direction_of[kMaxObservations];
float viewer_cosine[kMaxObservations];
vec3 highlight[kMaxObservations];  // as predicted; at first without ks and what does not depend on the light
vec3 rest[kMaxObservations];       // the colour without its highlight
vec3 channels[kMaxObservations];   // 1: counts, 0: does not
float trust[kMaxObservations];     // inverse variance; 0 where it does not count
float robust[kMaxObservations];

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
    const WardShape shape = ward_shape(alpha);
    for (uint i = 0u; i < count; ++i) {
        const FitLight light = fit_light(i, point_m, normal, reached);
        [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
            const float tan2 = tan2_of_half(light, direction_of[k], max(viewer_cosine[k], kFitLeastCosine));
            highlight[k] += light.gloss * ward_falloff(shape, tan2);
        }
    }
}

void take_highlights(uint record, vec3 ks_scale) {
    [[unroll]] for (uint quad = 0u; quad < kRecordQuads; ++quad) {
        const uvec4 words = load_colors(params.records.chunk_shift, record, quad);
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            const uint k = 4u * quad + i;
            if (k >= kMaxObservations) continue;
            highlight[k] *= ks_scale * ward_viewer_part(max(viewer_cosine[k], kFitLeastCosine));
            rest[k] = unpack_shared_exponent(words[i]) - highlight[k];
            channels[k] = vec3(not(observation_clipped(direction_word[k])));
        }
    }
}

// One noise for all of a voxel's observations: were that of dark ones less, those that miss a highlight's peak, as
// normals are estimates, would count for more than those that show it, and ks would come out too low.
void set_trust(uint count) {
    float brightness = 0.0, counted = 1e-20;
    [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
        trust[k] = k < count && viewer_cosine[k] >= kFitLeastCosine ? 1.0 : 0.0;
        robust[k] = 1.0;
        channels[k] *= trust[k];  // so far 0 or 1; what does not count must not meet an infinite mean
        brightness += trust[k] * mean_of(rest[k] + highlight[k]);
        counted += trust[k];
    }
    const float noise = kNoise + kRelativeNoise * brightness / counted;
    [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
        const float doubt = kHighlightError * mean_of(highlight[k]);
        trust[k] /= noise * noise + doubt * doubt;
    }
}

// Of what is left without highlights, by channel; what every observation clips is infinite.
vec3 mean_rest() {
    vec3 sum = vec3(0.0), weight_sum = vec3(0.0);
    [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
        const vec3 weight = trust[k] * robust[k] * channels[k];
        sum += weight * rest[k];
        weight_sum += weight;
    }
    return mix(sum / max(weight_sum, 1e-20), vec3(kInfinite), equal(weight_sum, vec3(0.0)));
}

// Clipped channels that are brighter than the mean of the others and their own highlight make it.
void take_clipped() {
    const vec3 mean = mean_rest();
    [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) channels[k] =
        max(channels[k], vec3(greaterThan(rest[k], mean)));
}

// Weights about the mean of the rest, with the deviation of the estimate so far.
void reweight(float deviation) {
    const float inverse_scale2 = 1.0 / (kRobustScale * kRobustScale * deviation * deviation);
    for (uint step = 0u; step < kRobustSteps; ++step) {
        const vec3 mean = mean_rest();
        [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
            const vec3 off = (rest[k] - mean) * channels[k];
            const float counted = max(dot(channels[k], vec3(1.0)), 1.0);
            const float share = 1.0 / (1.0 + dot(off, off) * trust[k] * inverse_scale2 / counted);
            // By how much a clipped channel is brighter than the estimate nobody knows: it is no outlier.
            robust[k] = any(observation_clipped(direction_word[k])) ? 1.0 : share * share;
        }
    }
}

void main() {
    const uint segment = gl_GlobalInvocationID.x / kSegmentSamples, slot = gl_GlobalInvocationID.x % kSegmentSamples;
    const FitVoxel voxel = voxels[gl_GlobalInvocationID.x];
    const uint record = voxel.record;
    if (record == kNoRecord) return;
    const VoxelRecord known = records[record];
    const vec3 normal = surface_normal(known);
    const WardFit fit = fits[batch[1u + segment]];
    const bool estimated = fit.estimates > 0u;
    const float alpha = estimated ? sqrt(fit.ks_alpha.w * fit.ks_alpha.w + voxel.blur2) : 1.0;  // as it is seen
    unpack_directions(record, normal);
    add_highlights(surface_point_m(known, params.records, params.edge_shift), normal, visibility[record], alpha,
                   estimated ? header.count : 0u);
    take_highlights(record, estimated ? fit.ks_alpha.rgb * ward_scale(alpha) : vec3(0.0));
    set_trust(observation_count(known));
    take_clipped();
    const bool glossy = any(greaterThan(fit.ks_alpha.rgb, vec3(kTrustedKs)));
    if (fit.confidence >= kTrustedConfidence && glossy) reweight(max(fit.deviation, kLeastOutlierDeviation));
    [[unroll]] for (uint k = 0u; k < kMaxObservations; ++k) {
        const float weight = trust[k] * robust[k];
        weights[(segment * kMaxObservations + k) * kSegmentSamples + slot] = weight > 0.0 ? weight : 0.0;  // nor NaN
    }
}
