#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per segment of a batch, one invocation per alpha: adds the frame's sums to those of the frames before;
// ks follows for each alpha, and the alpha of least cost is taken. What observations do not tell comes from a prior,
// the network's estimate where there is one.
#include "lib/fit_alphas.glsl"
#include "lib/set_material.glsl"
#include "shared/specular_estimates.h"
#include "shared/ward_fit.h"

layout(local_size_x = kFitGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 1) readonly buffer Sums { FitSums sums[]; };
layout(std430, binding = 2) readonly buffer Totals { vec4 totals[]; };
layout(std430, binding = 3) readonly buffer Network { WardMaterial network[]; };
layout(std430, binding = 4) buffer Curves { FitSums curves[]; };  // kFitAlphas per label
layout(std430, binding = 5) buffer Fits { WardFit fits[]; };
layout(std430, binding = 6) buffer Materials { SegmentMaterial materials[]; };
layout(push_constant) uniform Push { FitParams params; };

const float kLeastDeviation = 0.1;  // of observations, for the prior's weight
// Observations of one voxel, and voxels beside each other, err together: so many count as one.
const float kCorrelated = 50.0;
const float kKsDeviation = 0.15;    // of ks from 0, where no network has said anything
const float kAlphaDeviation = 2.0;  // octaves, of alpha from kAlphaBefore
const float kAlphaBefore = 0.2;
const float kNetworkKsDeviation = 0.06;    // of ks from the network's
const float kNetworkAlphaDeviation = 0.7;  // octaves
const float kDullKs = 0.01;                // whose roughness does not matter
const float kSeenLobe = 0.5;               // a view this near to the peak tells it; from flanks alone it is a guess
const float kSharpAlpha = 0.3;             // octaves, of an alpha that is known half

struct Prior {
    vec3 ks;
    float alpha;
    float ks_weight;  // of squared deviations, in units of the cost
    float alpha_weight;
};

shared vec4 ks_cost[kFitAlphas];
shared float known[kFitAlphas];  // the share of ks that observations tell

Prior prior_of(uint label, float deviation) {
    const float unit = kCorrelated * deviation * deviation;
    const WardMaterial said = network[label];
    const bool any_said = said.kd_weight.w > 0.0;
    const float ks = any_said ? kNetworkKsDeviation : kKsDeviation;
    const float alpha = any_said ? kNetworkAlphaDeviation : kAlphaDeviation;
    return Prior(any_said ? said.ks_alpha.rgb : vec3(0.0), any_said ? said.ks_alpha.w : kAlphaBefore, unit / (ks * ks),
                 unit / (alpha * alpha));
}

void solve_alpha(uint a, FitSums sum, vec3 color2, Prior prior) {
    const float alpha = fit_alpha(float(a)), scale = lobe_scale(alpha);
    const vec3 lobe2 = scale * scale * sum.lobe2.rgb, product = scale * sum.product.rgb;
    const vec3 ks = max((product + prior.ks_weight * prior.ks) / (lobe2 + prior.ks_weight), 0.0);
    const vec3 off = ks - prior.ks;
    const float octaves = log2(alpha / prior.alpha);
    const vec3 cost = color2 - 2.0 * ks * product + ks * ks * lobe2 + prior.ks_weight * off * off;
    ks_cost[a] = vec4(ks, dot(cost, vec3(1.0)) + prior.alpha_weight * octaves * octaves);
    known[a] = dot(lobe2 / (lobe2 + prior.ks_weight), vec3(1.0 / 3.0)) * min(sum.lobe2.w / kSeenLobe, 1.0);
}

uint least_cost() {
    uint best = 0u;
    for (uint a = 1u; a < kFitAlphas; ++a) best = ks_cost[a].w < ks_cost[best].w ? a : best;
    return best;
}

// ks and alpha at the minimum of the parabola through the best alpha and its neighbours.
vec4 refined(uint best) {
    if (best == 0u || best == kFitAlphas - 1u) return vec4(ks_cost[best].rgb, fit_alpha(float(best)));
    const vec4 before = ks_cost[best - 1u], at = ks_cost[best], after = ks_cost[best + 1u];
    const float bend = before.w - 2.0 * at.w + after.w;
    const float t = bend > 0.0 ? clamp(0.5 * (before.w - after.w) / bend, -0.5, 0.5) : 0.0;
    const vec3 ks = at.rgb + 0.5 * t * (after.rgb - before.rgb) + 0.5 * t * t * (before.rgb - 2.0 * at.rgb + after.rgb);
    return vec4(max(ks, 0.0), fit_alpha(float(best) + t));
}

// How much of ks the observations tell, over all alphas that they allow; and of alpha, where there is a highlight.
float confidence(uint best, float deviation, vec3 ks) {
    const float unit = 0.5 / (kCorrelated * deviation * deviation);
    float sum = 0.0, share = 0.0, place = 0.0, place2 = 0.0;
    for (uint a = 0u; a < kFitAlphas; ++a) {
        const float likely = exp(max((ks_cost[best].w - ks_cost[a].w) * unit, -60.0));
        const float at = (float(a) - float(best)) / float(kFitAlphaSteps);
        sum += likely;
        share += likely * known[a];
        place += likely * at;
        place2 += likely * at * at;
    }
    const float variance = max(place2 / sum - place * place / (sum * sum), 0.0);
    const bool dull = max(max(ks.r, ks.g), ks.b) < kDullKs;
    return share / sum * (dull ? 1.0 : 1.0 / (1.0 + variance / (kSharpAlpha * kSharpAlpha)));
}

void main() {
    const uint segment = gl_WorkGroupID.x, a = gl_LocalInvocationIndex;
    const uint label = batch[1u + segment];
    if (label >= params.labels) return;
    WardFit fit = fits[label];
    const float kept = fit.estimates > 0u ? params.memory : 0.0;
    fit.color2_weight = totals[segment] + (kept > 0.0 ? kept * fit.color2_weight : vec4(0.0));
    const float deviation = max(fit.estimates > 0u ? fit.deviation : 1.0, kLeastDeviation);
    const Prior prior = prior_of(label, deviation);
    if (a < kFitAlphas) {
        FitSums sum = sums[segment * kFitAlphas + a];
        if (kept > 0.0) {
            const vec4 before = kept * curves[label * kFitAlphas + a].lobe2;
            sum.lobe2 = vec4(sum.lobe2.rgb + before.rgb, max(sum.lobe2.w, before.w));
            sum.product += kept * curves[label * kFitAlphas + a].product;
        }
        curves[label * kFitAlphas + a] = sum;
        solve_alpha(a, sum, fit.color2_weight.rgb, prior);
    }
    barrier();
    // Without an observation only the prior is known; it may change before there is one.
    if (a != 0u) return;
    const uint best = least_cost();
    fit.ks_alpha = refined(best);
    fit.confidence = confidence(best, deviation, fit.ks_alpha.rgb);
    fit.deviation = sqrt(max(ks_cost[best].w, 0.0) / max(fit.color2_weight.w, 1.0));
    fit.estimates = fit.color2_weight.w > 0.0 ? min(fit.estimates + 1u, 0xffffu) : 0u;
    fits[label] = fit;
    if (label < params.materials) materials[label] = changed_material(materials[label], fit.ks_alpha);
}
