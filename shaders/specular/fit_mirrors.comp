#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per segment of the batch: how much of a change in what mirrored rays meet shows in the colours.
#include "lib/brdf/ward.glsl"
#include "lib/math/mean.glsl"
#include "lib/math/random.glsl"
#include "lib/records/record_hash.glsl"
#include "lib/records/reflectance.glsl"
#include "shared/reflectance/far_field.h"
#include "shared/specular/mirror_fit.h"

layout(local_size_x = kMirrorGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer Pairs { MirrorPair pairs[]; };  // kSegmentSamples per segment
layout(std430, binding = 3) readonly buffer Surroundings{SURROUNDINGS_MEMBERS};
layout(std430, binding = 4) buffer Mirrors { MirrorFit mirrors[]; };
layout(std430, binding = 5) buffer Materials { SegmentMaterial materials[]; };
layout(push_constant) uniform Push { MirrorParams params; };
#include "lib/lighting/march_surroundings.glsl"

const float kLobeAlpha = 0.06;  // of the mirrors that are looked for
const uint kRaysOfSet = 2u;
const float kMost = 4.0;  // of a difference, so that 32 bits hold the sums
const float kSteps = 65536.0;
const uint kLeastPairs = 8u;     // of a look, of kSegmentSamples
const uint kMostMissed = 4u;     // of so many pairs of views, at least one shows what surroundings are known of
const float kErrors = 2.0;       // from the estimate down to what is sure
const float kGlassKs = 0.1;      // no dielectric reflects more, but for flat views,
const float kMetalKs = 0.25;     // and no metal less
const float kMirrorStep = 0.04;  // a change that is worth another look at the albedo

shared int sum_product;
shared int sum_square;
shared int sum_product2;
shared uint sum_pairs;
shared uint sum_views;  // pairs, whether or not their rays meet anything
shared uint sum_few;    // voxels that were seen too seldom

// The mean brightness that the rays of a set meet on the way to the viewer; a negative one where they meet nothing.
// What is brighter than pixels can be counts as that bright: views of it are clipped, and left out.
float mirrored(vec3 point_m, vec3 normal, vec3 to_viewer, uvec2 stream, uint set) {
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < kRaysOfSet; ++i) {
        const vec3 direction = sample_ward(kLobeAlpha, normal, to_viewer, random_numbers(stream, set, i).xy);
        if (dot(direction, normal) > 0.0) sum += min(march_surroundings(point_m, normal, direction).color, 1.0);
    }
    return sum.a > 0.0 ? mean_of(sum.rgb) / sum.a : -1.0;
}

void add_pair(MirrorPair pair) {
    const VoxelRecord known = records[pair.record];
    const vec3 normal = surface_normal(known);
    const vec3 point_m = surface_point_m(known, params.records, params.edge_shift);
    const uvec2 stream = uvec2(hash_of_voxel(known.block_key, voxel_in_block(known)), params.stamp);
    vec2 differs = vec2(0.0);
    bool all_met = true;
    for (uint set = 0u; set < 2u; ++set) {
        const float first = mirrored(point_m, normal, observation_direction(pair.first), stream, 2u * set);
        const float second = mirrored(point_m, normal, observation_direction(pair.second), stream, 2u * set + 1u);
        differs[set] = first - second;
        all_met = all_met && first >= 0.0 && second >= 0.0;
    }
    if (!all_met) return;
    const float brighter = clamp(pair.brighter, -kMost, kMost);
    const float product = brighter * 0.5 * (differs.x + differs.y);
    atomicAdd(sum_product, int(round(product * kSteps)));
    atomicAdd(sum_square, int(round(differs.x * differs.y * kSteps)));
    atomicAdd(sum_product2, int(round(min(product * product, kMost) * kSteps)));
    atomicAdd(sum_pairs, 1u);
}

// 0: what the segment shows is its own colour; 1: it is sure to be a metal or a mirror, which have no diffuse part.
// The same voxels come again in each look: `looks` times as many pairs make the error no smaller.
float mirror_of(MirrorFit fit, float looks) {
    const float sure = fit.product - kErrors * sqrt(fit.product2 * looks);
    return fit.square > 0.0 ? smoothstep(kGlassKs, kMetalKs, sure / fit.square) : 0.0;
}

void main() {
    const uint segment = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    const uint label = batch[1u + segment];
    if (lane == 0u) {
        sum_product = sum_square = sum_product2 = 0;
        sum_pairs = sum_views = sum_few = 0u;
    }
    barrier();
    for (uint slot = lane; slot < kSegmentSamples; slot += kMirrorGroup) {
        const MirrorPair pair = pairs[segment * kSegmentSamples + slot];
        if (pair.record == kNoRecord) {
            if (pair.first == kFewViews) atomicAdd(sum_few, 1u);
            continue;
        }
        atomicAdd(sum_views, 1u);
        add_pair(pair);
    }
    barrier();
    // A look that finds next to nothing tells nothing, and is no reason to doubt the ones before. The few rays that
    // meet something, where most go into the open, meet what stands on the surface: its rims, where colours change
    // anyway. Nor do the first voxels that were seen often tell of all the others.
    if (lane != 0u || label >= params.labels || sum_pairs < max(kLeastPairs, sum_views / kMostMissed)) return;
    if (sum_views < sum_few) return;
    const MirrorFit before = mirrors[label];
    const MirrorFit fit = MirrorFit(params.memory * before.product + float(sum_product) / kSteps,
                                    params.memory * before.square + float(sum_square) / kSteps,
                                    params.memory * before.product2 + float(sum_product2) / kSteps,
                                    params.memory * before.pairs + float(sum_pairs));
    mirrors[label] = fit;
    if (label >= params.materials) return;
    const float mirror = mirror_of(fit, fit.pairs / float(sum_pairs));
    if (abs(mirror - materials[label].mirror) < kMirrorStep) return;
    materials[label].mirror = mirror;
    materials[label].version = materials[label].version % 0xffffu + 1u;
}
