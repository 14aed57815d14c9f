#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Normal equations of the Ward fit. One workgroup per segment and block of alphas: each invocation sums up some of the
// segment's voxels, then one adds up what all have, always in the same order. The voxel's diffuse part, whose
// irradiance does not depend on the view, drops out with the mean over its observations. A clipped channel is at least
// as bright as it was recorded: for each alpha it counts where what the fits before found for that alpha is darker, and
// says nothing where it is not (a censored regression); before the first fit it says nothing. Left out altogether, only
// those of a sharp highlight's observations would remain that missed its peak; taken as recorded, they would hold down
// what its flanks tell.
#include "lib/brdf/fit_alphas.glsl"
#include "lib/brdf/ward.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/records/reflectance.glsl"
#include "shared/specular/ward_fit.h"

layout(local_size_x = kFitGroup) in;
layout(std140, binding = 0) uniform Lights {
    LightHeader header;
    PointLight lights[kMaxPointLights];
};
layout(std430, binding = 1) readonly buffer Voxels { FitVoxel voxels[]; };
layout(std430, binding = 2) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 3) readonly buffer Visibility { uvec2 visibility[]; };
layout(std430, binding = 4) readonly buffer Weights { float weights[]; };
layout(std430, binding = 5) readonly buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 10) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(std430, binding = 15) readonly buffer Before { vec4 ks_before[]; };  // by segment, then by alpha
layout(std430, binding = 16) writeonly buffer Sums { FitSums sums[]; };     // likewise
layout(push_constant) uniform Push { FitParams params; };
#include "lib/lighting/fit_lights.glsl"
#include "lib/records/record_colors.glsl"
#include "lib/records/record_directions.glsl"

const uint kAlphas = kFitAlphasPerGroup;
const uint kAlphasAtOnce = 4u;  // added up: the rows of all would not fit 16 KiB
const uint kRowsPerAlpha = 11u;
const uint kRows = kAlphasAtOnce * kRowsPerAlpha;

const float kNoWeight = 1e-20;
const float kFarTan2 = 1e3;
// A view tells a peak where its lobe is this high, as seen: from flanks alone it is a guess, and much blur leaves
// little.
const float kSeenLobe = 0.5;

shared float partial[kRows][kFitGroup + 1u];

FitSums segment_sums[kAlphas];
vec3 ks_scaled[kAlphas];  // what the fits before found, as it multiplies lobes
float nearest_tan2;       // of a voxel's views and mirrored lights
vec3 lobes[kAlphas];      // of an observation

WardShape blurred[kAlphas];  // the lobes of a voxel, whose surface bends

void blur_lobes(uint first_alpha, float blur2) {
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) blurred[a] =
        ward_shape_blurred(fit_alpha(float(first_alpha + a)), blur2);
}

struct Voxel {
    uint record;
    uint first;  // of its weights
    vec3 point_m;
    vec3 normal;
    uvec2 reached;
};

void add_lobes(vec3 gloss, float tan2) {
    const float lit = any(greaterThan(gloss, vec3(0.0))) ? tan2 : kFarTan2;
    nearest_tan2 = min(nearest_tan2, lit);
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) lobes[a] += gloss * ward_falloff(blurred[a], tan2);
}

void find_lobes(Voxel voxel, uint direction_word) {
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) lobes[a] = vec3(0.0);
    const vec3 to_viewer = observation_direction(direction_word);
    const float cosine = max(dot(to_viewer, voxel.normal), kFitLeastCosine), bend = ward_viewer_part(cosine);
    for (uint i = 0u; i < header.count; ++i) {
        const FitLight light = fit_light(i, voxel.point_m, voxel.normal, voxel.reached);
        add_lobes(light.gloss * bend, tan2_of_half(light, to_viewer, cosine));
    }
}

// What is known of a voxel's observations before their lobes are.
struct VoxelColors {
    vec3 weight;   // of unclipped channels
    vec3 mean;     // of these
    uint clipped;  // a bit per observation of which some channel is
};

VoxelColors load_voxel_colors(Voxel voxel) {
    vec3 weight_sum = vec3(0.0), color_sum = vec3(0.0);
    uint clipped = 0u;
    for (uint quad = 0u; quad < kRecordQuads; ++quad) {
        const uvec4 color_words = load_colors(params.records.chunk_shift, voxel.record, quad);
        const uvec4 direction_words = load_directions(params.records.chunk_shift, voxel.record, quad);
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            const uint k = min(4u * quad + i, kMaxObservations - 1u);
            const float weight = 4u * quad + i < kMaxObservations ? weights[voxel.first + k * kSegmentSamples] : 0.0;
            const bvec3 is_clipped = observation_clipped(direction_words[i]);
            const vec3 channels = weight * vec3(not(is_clipped));
            weight_sum += channels;
            color_sum += weight > 0.0 ? channels * unpack_shared_exponent(color_words[i]) : vec3(0.0);
            clipped |= weight > 0.0 && any(is_clipped) ? 1u << k : 0u;
        }
    }
    return VoxelColors(weight_sum, color_sum / max(weight_sum, kNoWeight), clipped);
}

// Sums over what counts of a voxel's observations, for one alpha. Colours are without the mean of the unclipped ones.
struct VoxelSums {
    vec3 weight;
    vec3 lobe;
    vec3 lobe2;
    vec3 color;
    vec3 product;
    vec3 color2;
    float count;
};
VoxelSums voxel_sums[kAlphas];

void add_channels(uint a, vec3 counts, float weight, vec3 off) {
    const vec3 channels = weight * counts, weighted = channels * lobes[a];
    voxel_sums[a].weight += channels;
    voxel_sums[a].lobe += weighted;
    voxel_sums[a].lobe2 += weighted * lobes[a];
    voxel_sums[a].color += channels * off;
    voxel_sums[a].product += weighted * off;
    voxel_sums[a].color2 += channels * off * off;
    voxel_sums[a].count += dot(counts, vec3(1.0));
}

vec3 color_of(Voxel voxel, uint k) {
    return unpack_shared_exponent(load_color(params.records.chunk_shift, voxel.record, k));
}

void add_unclipped(Voxel voxel, VoxelColors seen) {
    for (uint k = 0u; k < kMaxObservations; ++k) {
        const float weight = weights[voxel.first + k * kSegmentSamples];
        if (weight == 0.0) continue;
        const uint word = load_direction(params.records.chunk_shift, voxel.record, k);
        const vec3 counts = vec3(not(observation_clipped(word))), off = color_of(voxel, k) - seen.mean;
        find_lobes(voxel, word);
        [[unroll]] for (uint a = 0u; a < kAlphas; ++a) add_channels(a, counts, weight, off);
    }
}

// Clipped channels of which the fits before predict less than what was recorded.
void add_clipped(Voxel voxel, VoxelColors seen) {
    const vec3 known = vec3(greaterThan(seen.weight, vec3(0.0)));
    vec3 mean_lobe[kAlphas];
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) mean_lobe[a] =
        voxel_sums[a].lobe / max(voxel_sums[a].weight, kNoWeight);
    for (uint bits = seen.clipped; bits != 0u; bits &= bits - 1u) {
        const uint k = uint(findLSB(bits));
        const uint word = load_direction(params.records.chunk_shift, voxel.record, k);
        const float weight = weights[voxel.first + k * kSegmentSamples];
        const vec3 clipped = known * vec3(observation_clipped(word)), off = color_of(voxel, k) - seen.mean;
        find_lobes(voxel, word);
        [[unroll]] for (uint a = 0u; a < kAlphas; ++a) {
            const vec3 predicted = ks_scaled[a] * (lobes[a] - mean_lobe[a]);
            add_channels(a, clipped * vec3(greaterThan(off, predicted)), weight, off);
        }
    }
}

void add_voxel(Voxel voxel, bool fitted) {
    VoxelColors seen = load_voxel_colors(voxel);
    seen.clipped = fitted ? seen.clipped : 0u;
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) voxel_sums[a] =
        VoxelSums(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
    nearest_tan2 = kFarTan2;
    add_unclipped(voxel, seen);
    add_clipped(voxel, seen);
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) {
        const VoxelSums own = voxel_sums[a];
        const vec3 mean_lobe = own.lobe / max(own.weight, kNoWeight);
        const vec3 mean_color = own.color / max(own.weight, kNoWeight);
        // Views count as near a peak where they are clipped, too, even if all of the voxel's are: that it is bright is
        // known, though not how bright.
        const float peak = ward_falloff(blurred[a], nearest_tan2);
        segment_sums[a].lobe2 += vec4(max(own.lobe2 - mean_lobe * own.lobe, 0.0), min(peak * (1.0 / kSeenLobe), 1.0));
        segment_sums[a].product += vec4(own.product - mean_color * own.lobe, 0.0);
        segment_sums[a].color2 += vec4(max(own.color2 - mean_color * own.color, 0.0), own.count);
    }
}

// Adds up what four alphas have in all invocations.
void write_sums(uint segment, uint first_alpha, FitSums own[kAlphasAtOnce]) {
    const uint lane = gl_LocalInvocationIndex;
    [[unroll]] for (uint a = 0u; a < kAlphasAtOnce; ++a) {
        const uint row = kRowsPerAlpha * a;
        [[unroll]] for (uint c = 0u; c < 4u; ++c) {
            partial[row + c][lane] = own[a].lobe2[c];
            partial[row + 4u + c][lane] = own[a].color2[c];
        }
        [[unroll]] for (uint c = 0u; c < 3u; ++c) partial[row + 8u + c][lane] = own[a].product[c];
    }
    barrier();
    if (lane < kRows) {
        float sum = 0.0;
        for (uint i = 0u; i < kFitGroup; ++i) sum += partial[lane][i];
        partial[lane][0] = sum;
    }
    barrier();
    if (lane < kAlphasAtOnce) {
        const uint row = kRowsPerAlpha * lane;
        sums[segment * kFitAlphas + first_alpha + lane] =
            FitSums(vec4(partial[row][0], partial[row + 1u][0], partial[row + 2u][0], partial[row + 3u][0]),
                    vec4(partial[row + 8u][0], partial[row + 9u][0], partial[row + 10u][0], 0.0),
                    vec4(partial[row + 4u][0], partial[row + 5u][0], partial[row + 6u][0], partial[row + 7u][0]));
    }
    barrier();
}

void main() {
    const uint segment = gl_WorkGroupID.x, first_alpha = gl_WorkGroupID.y * kAlphas;
    const bool fitted = ks_before[segment * kFitAlphas].w > 0.0;
    [[unroll]] for (uint a = 0u; a < kAlphas; ++a) {
        segment_sums[a] = FitSums(vec4(0.0), vec4(0.0), vec4(0.0));
        ks_scaled[a] =
            ks_before[segment * kFitAlphas + first_alpha + a].rgb * ward_scale(fit_alpha(float(first_alpha + a)));
    }
    for (uint slot = gl_LocalInvocationIndex; slot < kSegmentSamples; slot += kFitGroup) {
        const FitVoxel chosen = voxels[segment * kSegmentSamples + slot];
        if (chosen.record == kNoRecord) continue;
        const VoxelRecord record = records[chosen.record];
        if (observation_count(record) < kFitLeastObservations) continue;
        blur_lobes(first_alpha, chosen.blur2);
        add_voxel(Voxel(chosen.record, segment * kMaxObservations * kSegmentSamples + slot,
                        surface_point_m(record, params.records, params.edge_shift), surface_normal(record),
                        visibility[chosen.record]),
                  fitted);
    }
    [[unroll]] for (uint part = 0u; part < kAlphas / kAlphasAtOnce; ++part) {
        FitSums own[kAlphasAtOnce];
        [[unroll]] for (uint a = 0u; a < kAlphasAtOnce; ++a) own[a] = segment_sums[part * kAlphasAtOnce + a];
        write_sums(segment, first_alpha + part * kAlphasAtOnce, own);
    }
}
