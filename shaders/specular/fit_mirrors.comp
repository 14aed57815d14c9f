#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per segment of the batch: how much of a change in what mirrored rays meet shows in the colours.
#include "lib/math/mean.glsl"
#include "shared/specular/mirror_fit.h"

layout(local_size_x = kMirrorGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };        // count, then labels
layout(std430, binding = 1) readonly buffer Pairs { MirrorPair pairs[]; };  // kSegmentSamples per segment
layout(std430, binding = 2) readonly buffer Mirrored { vec4 mirrored[]; };  // kMirrorSets per pair
layout(std430, binding = 3) buffer Mirrors { MirrorFit mirrors[]; };
layout(std430, binding = 4) buffer Materials { SegmentMaterial materials[]; };
layout(push_constant) uniform Push { MirrorParams params; };

const float kMost = 4.0;  // of a difference, so that 32 bits hold the sums
const float kSteps = 65536.0;
const uint kLeastPairs = 24u;  // of a look, of kSegmentSamples: fewer agree by chance
const uint kMostMissed = 4u;   // of so many pairs of views, at least one shows what surroundings are known of
const float kErrors = 2.0;     // from the estimate down to what is sure
const float kGlassKs = 0.1;    // no dielectric reflects more, but for flat views,
const float kMetalKs = 0.25;   // and no metal less
const float kWhiteKs = 1.2;    // what a perfect mirror may be found to have, as its rays err,
const float kMostKs = 1.4;     // and none has whose surroundings are known
const float kByChance = 0.3, kByMirroring = 0.45;          // correlations
const float kDimSurroundings = 0.5, kSureDim = 0.6;        // those that speak for surroundings which are too even,
const float kMostCorrelation = 1.3, kNoCorrelation = 1.6;  // and those of a square that is but its rays' error
const float kMirrorStep = 0.04;                            // a change that is worth another look at the albedo

shared int sum_product[4];  // channels, brightness
shared int sum_square[4];
shared int sum_product2;
shared int sum_color2;
shared uint sum_pairs;
shared uint sum_views;  // pairs, whether or not their rays meet anything
shared uint sum_few;    // voxels that were seen too seldom

// Colour and brightness.
vec4 with_mean(vec3 color) { return vec4(color, mean_of(color)); }

void add_pair(MirrorPair pair, uint at) {
    vec4 differs[2];
    bool all_met = true;
    for (uint set = 0u; set < 2u; ++set) {
        const vec4 first = mirrored[at * kMirrorSets + 2u * set], second = mirrored[at * kMirrorSets + 2u * set + 1u];
        differs[set] = with_mean(first.rgb - second.rgb);
        all_met = all_met && first.a > 0.0 && second.a > 0.0;
    }
    if (!all_met) return;
    const vec4 brighter = clamp(with_mean(pair.brighter.rgb), -kMost, kMost);
    const vec4 product = brighter * 0.5 * (differs[0] + differs[1]), square = differs[0] * differs[1];
    for (uint i = 0u; i < 4u; ++i) {
        atomicAdd(sum_product[i], int(round(product[i] * kSteps)));
        atomicAdd(sum_square[i], int(round(square[i] * kSteps)));
    }
    atomicAdd(sum_product2, int(round(min(product.w * product.w, kMost) * kSteps)));
    atomicAdd(sum_color2, int(round(min(brighter.w * brighter.w, kMost) * kSteps)));
    atomicAdd(sum_pairs, 1u);
}

vec4 sum_of(int sums[4]) { return vec4(sums[0], sums[1], sums[2], sums[3]) / kSteps; }

// 0: what the segment shows is its own colour; 1: it is sure to be a metal or a mirror, which have no diffuse part.
// The same voxels come again in each look: `looks` times as many pairs make the error no smaller. Pairs of the same two
// frames err alike, so that chance is larger than it looks; but a mirror's colours change by what it mirrors, and by
// little else. They change by more only where what is known of its surroundings is too even, as of a sky that was seen
// near the horizon alone; then they change with it all the same.
float mirror_of(MirrorFit fit, float looks) {
    if (fit.square.w <= 0.0) return 0.0;
    const float sure = fit.product.w - kErrors * sqrt(fit.product2 * looks);
    const float correlation = max(fit.product.w, 0.0) * inversesqrt(max(fit.square.w * fit.color2, 1e-12));
    const float too_much = smoothstep(kWhiteKs, kMostKs, fit.product.w / fit.square.w) *
                           (1.0 - smoothstep(kDimSurroundings, kSureDim, correlation));
    return smoothstep(kGlassKs, kMetalKs, sure / fit.square.w) * smoothstep(kByChance, kByMirroring, correlation) *
           (1.0 - smoothstep(kMostCorrelation, kNoCorrelation, correlation)) * (1.0 - too_much);
}

void main() {
    const uint segment = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    const uint label = batch[1u + segment];
    if (lane < 4u) sum_product[lane] = sum_square[lane] = 0;
    if (lane == 0u) {
        sum_product2 = sum_color2 = 0;
        sum_pairs = sum_views = sum_few = 0u;
    }
    barrier();
    for (uint slot = lane; slot < kSegmentSamples; slot += kMirrorGroup) {
        const uint at = segment * kSegmentSamples + slot;
        const MirrorPair pair = pairs[at];
        if (pair.record == kNoRecord) {
            if (pair.first == kFewViews) atomicAdd(sum_few, 1u);
            continue;
        }
        atomicAdd(sum_views, 1u);
        add_pair(pair, at);
    }
    barrier();
    // A look that finds next to nothing tells nothing, and is no reason to doubt the ones before. The few rays that
    // meet something, where most go into the open, meet what stands on the surface: its rims, where colours change
    // anyway. Nor do the first voxels that were seen often tell of all the others.
    if (lane != 0u || label >= params.labels || sum_pairs < max(kLeastPairs, sum_views / kMostMissed)) return;
    if (sum_views < sum_few) return;
    const MirrorFit before = mirrors[label];
    const MirrorFit fit = MirrorFit(
        params.memory * before.product + sum_of(sum_product), params.memory * before.square + sum_of(sum_square),
        params.memory * before.product2 + float(sum_product2) / kSteps, params.memory * before.pairs + float(sum_pairs),
        params.memory * before.color2 + float(sum_color2) / kSteps, 0u);
    mirrors[label] = fit;
    if (label >= params.materials) return;
    const float mirror = mirror_of(fit, fit.pairs / float(sum_pairs));
    if (abs(mirror - materials[label].mirror) < kMirrorStep) return;
    materials[label].mirror = mirror;
    materials[label].version = materials[label].version % 0xffffu + 1u;
}
