#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per segment of a batch, one invocation per alpha: adds the frame's sums to those of the frames before;
// ks follows for each alpha. What observations do not tell comes from a prior, whose alpha is the network's where there
// is one. The result is the mean over all alphas by how likely they are, given what was seen (Bayesian model
// averaging): an alpha of which no view could tell is not less likely than one whose highlight was looked for in vain.
#include "lib/brdf/fit_alphas.glsl"
#include "lib/brdf/fit_prior.glsl"
#include "lib/brdf/ward.glsl"
#include "lib/lighting/set_material.glsl"
#include "lib/math/mean.glsl"
#include "shared/specular/mirror_fit.h"
#include "shared/specular/specular_estimates.h"
#include "shared/specular/ward_fit.h"

layout(local_size_x = kFitGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 1) readonly buffer Sums { FitSums sums[]; };
layout(std430, binding = 2) readonly buffer Network { WardMaterial network[]; };
layout(std430, binding = 3) buffer Curves { FitCurve curves[]; };  // kFitAlphas per label
layout(std430, binding = 4) buffer Fits { WardFit fits[]; };
layout(std430, binding = 5) buffer Materials { SegmentMaterial materials[]; };
layout(std430, binding = 6) readonly buffer Mirrors { MirrorFit mirrors[]; };
layout(push_constant) uniform Push { FitParams params; };

const float kAlphaDeviation = 1.3;  // octaves, of alpha from kAlphaBefore, where no network has said anything
const float kAlphaBefore = 0.2;
const float kNetworkAlphaDeviation = 0.7;  // octaves, from the network's
const float kDullKs = 0.01;                // whose roughness does not matter
const float kIgnoredVoxels = 2.0;          // seen near the peak: so few may be there for wrong normals,
const float kSeenVoxels = 6.0;             // and with so many all are believed
const float kSharpAlpha = 0.3;             // octaves, of an alpha that is known half

const float kObservedConfidence = 0.5;   // from which on highlights tell of gloss
const float kAgreeingShare = 0.5;        // of the ks that surroundings tell
const float kMostMirrorAlpha = 0.25;     // a wider lobe blurs what is mirrored,
const float kUnblurredShare = 0.66;      // and leaves less than this of its contrasts, and of the ks that they tell
const float kLeastShareOfSquare = 0.25;  // of what is mirrored, of a channel: with less it tells nothing of its own

// A strong gloss far bluer than the lamps is not theirs: it is the sky in a window. Of 66 measured materials (MERL, as
// fitted by Ngan, Durand and Matusik 2005) none with a ks of 0.1 or more is bluer than grey ones by over a tenth.
const vec2 kStrongKs = vec2(0.2, 0.3);  // from where on it is doubted, and not believed
const vec2 kBlueKs = vec2(1.3, 1.6);    // blue over red, likewise

struct Prior {
    float alpha;
    float ks_weight;  // of squared deviations, in units of the cost
    float alpha_weight;
};

shared vec4 ks_misfit[kFitAlphas];  // the weighted sum of squared errors
shared float score[kFitAlphas];     // likelihood and prior: -2 log of it, in units of the misfit
shared float known[kFitAlphas];     // the share of ks that observations tell
shared vec4 observed[kFitAlphas];   // FitSums::color2

Prior prior_of(uint label, float unit) {
    const WardMaterial said = network[label];
    const bool any_said = said.kd_weight.w > 0.0;
    const float deviation = any_said ? kNetworkAlphaDeviation : kAlphaDeviation;
    return Prior(any_said ? said.ks_alpha.w : kAlphaBefore, unit / (kKsDeviation * kKsDeviation),
                 unit / (deviation * deviation));
}

// `unit`: of the misfit, what is as unlikely as one deviation of one independent observation.
vec3 solve_alpha(uint a, FitSums sum, Prior prior, float unit) {
    const float alpha = fit_alpha(float(a)), scale = ward_scale(alpha);
    const float seen = clamp((sum.lobe2.w - kIgnoredVoxels) / (kSeenVoxels - kIgnoredVoxels), 0.0, 1.0);
    const vec3 lobe2 = seen * scale * scale * sum.lobe2.rgb, product = seen * scale * sum.product.rgb;
    const vec3 stiffness = lobe2 + prior.ks_weight;
    const vec3 ks = max((product + prior.ks_weight * kKsBefore) / stiffness, 0.0);
    const vec3 off = ks - kKsBefore, misfit = sum.color2.rgb - 2.0 * ks * product + ks * ks * lobe2;
    const float octaves = log2(alpha / prior.alpha);
    ks_misfit[a] = vec4(ks, dot(misfit, vec3(1.0)));
    // Over all ks, the likelihood's integral: the better an alpha would show ks, the less of it is left.
    const float narrowed = dot(log(stiffness / prior.ks_weight), vec3(1.0));
    score[a] = ks_misfit[a].w + dot(prior.ks_weight * off * off, vec3(1.0)) + prior.alpha_weight * octaves * octaves +
               unit * narrowed;
    known[a] = dot(lobe2 / stiffness, vec3(1.0 / 3.0));
    observed[a] = sum.color2;
    return ks;
}

uint best_alpha() {
    uint best = 0u;
    for (uint a = 1u; a < kFitAlphas; ++a) best = score[a] < score[best] ? a : best;
    return best;
}

// ks and alpha at the minimum of the parabola through the best alpha and its neighbours.
vec4 refined(uint best) {
    if (best == 0u || best == kFitAlphas - 1u) return vec4(ks_misfit[best].rgb, fit_alpha(float(best)));
    const float bend = score[best - 1u] - 2.0 * score[best] + score[best + 1u];
    const float t = bend > 0.0 ? clamp(0.5 * (score[best - 1u] - score[best + 1u]) / bend, -0.5, 0.5) : 0.0;
    const vec3 before = ks_misfit[best - 1u].rgb, at = ks_misfit[best].rgb, after = ks_misfit[best + 1u].rgb;
    const vec3 ks = at + 0.5 * t * (after - before) + 0.5 * t * t * (before - 2.0 * at + after);
    return vec4(max(ks, 0.0), fit_alpha(float(best) + t));
}

struct Estimate {
    vec4 ks_alpha;
    float observed;  // the share of ks that observations tell
    float confidence;
};

// The mean over all alphas; where one step of the grid holds them all, the minimum between its steps. The confidence:
// how much of ks the observations tell, and of alpha, where there is a highlight.
Estimate averaged(uint best, float unit) {
    vec3 ks = vec3(0.0);
    float sum = 0.0, share = 0.0, place = 0.0, place2 = 0.0;
    for (uint a = 0u; a < kFitAlphas; ++a) {
        const float likely = exp(max(0.5 * (score[best] - score[a]) / unit, -60.0));
        const float at = float(a) - float(best);
        sum += likely;
        ks += likely * ks_misfit[a].rgb;
        share += likely * known[a];
        place += likely * at;
        place2 += likely * at * at;
    }
    const float step = place / sum, variance = max(place2 / sum - step * step, 0.0);
    const vec4 mean = vec4(ks / sum, fit_alpha(float(best) + step));
    const vec4 ks_alpha = mix(refined(best), mean, min(variance, 1.0));
    const bool dull = max(max(ks_alpha.r, ks_alpha.g), ks_alpha.b) < kDullKs;
    const float octaves2 = variance / float(kFitAlphaSteps * kFitAlphaSteps);
    return Estimate(ks_alpha, share / sum,
                    share / sum * (dull ? 1.0 : 1.0 / (1.0 + octaves2 / (kSharpAlpha * kSharpAlpha))));
}

// What is believed of an estimate; of the rest only the prior is known.
Estimate believed(Estimate estimate, Prior prior) {
    const vec3 ks = estimate.ks_alpha.rgb;
    const float strong = smoothstep(kStrongKs.x, kStrongKs.y, max(max(ks.r, ks.g), ks.b));
    const float share = 1.0 - strong * smoothstep(kBlueKs.x, kBlueKs.y, ks.b / max(ks.r, 1e-6));
    return Estimate(mix(vec4(vec3(kKsBefore), prior.alpha), estimate.ks_alpha, share), share * estimate.observed,
                    share * estimate.confidence);
}

// Of a segment that is sure to be a metal or a mirror: what the surroundings that it mirrors tell, where highlights
// tell too little; or far less, as they do when they are sharp and clipped; or of a wide lobe, where it mirrors sharply
// (what the room sends is then taken for light of the lamps). Else 0.
vec4 mirrored_material(uint label, float mirror, Estimate highlights) {
    const MirrorFit fit = mirrors[label];
    if (mirror < kSureMirror || fit.square.w <= 0.0) return vec4(0.0);
    const vec3 square = max(fit.square.rgb, kLeastShareOfSquare * fit.square.w);
    const vec3 ks = clamp(fit.product.rgb / square, 0.0, 1.0);
    const float told = mean_of(highlights.ks_alpha.rgb);
    const bool blurred = highlights.ks_alpha.a > kMostMirrorAlpha && mean_of(ks) > kUnblurredShare * told;
    const bool agree = told > kAgreeingShare * mean_of(ks) && !blurred;
    return agree && highlights.confidence >= kObservedConfidence ? vec4(0.0) : vec4(ks, kMirrorAlpha);
}

void main() {
    const uint segment = gl_WorkGroupID.x, a = gl_LocalInvocationIndex;
    const uint label = batch[1u + segment];
    if (label >= params.labels) return;
    WardFit fit = fits[label];
    const float kept = fit.estimates > 0u ? params.memory : 0.0;
    const float deviation = max(fit.estimates > 0u ? fit.deviation : 1.0, kLeastDeviation);
    const float unit = kCorrelated * deviation * deviation;
    const Prior prior = prior_of(label, unit);
    if (a < kFitAlphas) {
        FitSums sum = sums[segment * kFitAlphas + a];
        if (kept > 0.0) {
            const FitSums before = curves[label * kFitAlphas + a].sums;
            sum.lobe2 = vec4(sum.lobe2.rgb + kept * before.lobe2.rgb, max(sum.lobe2.w, kept * before.lobe2.w));
            sum.product += kept * before.product;
            sum.color2 += kept * before.color2;
        }
        curves[label * kFitAlphas + a] = FitCurve(sum, vec4(solve_alpha(a, sum, prior, unit), 0.0));
    }
    barrier();
    // Without an observation only the prior is known; it may change before there is one.
    if (a != 0u) return;
    const uint best = best_alpha();
    const Estimate estimate = believed(averaged(best, unit), prior);
    fit.color2_weight = observed[best];
    fit.ks_alpha = estimate.ks_alpha;
    fit.confidence = estimate.confidence;
    fit.deviation = sqrt(max(ks_misfit[best].w, 0.0) / max(fit.color2_weight.w, 1.0));
    fit.estimates = fit.color2_weight.w > 0.0 ? min(fit.estimates + 1u, 0xffffu) : 0u;
    const bool has_entry = label < params.materials;
    const SegmentMaterial before = materials[has_entry ? label : 0u];
    fit.mirrored = has_entry ? mirrored_material(label, before.mirror, estimate) : vec4(0.0);
    fits[label] = fit;
    if (!has_entry) return;
    materials[label] = fit.mirrored.w > 0.0 ? changed_material(before, fit.mirrored, 0.0)
                                            : changed_material(before, fit.ks_alpha, 1.0 - estimate.observed);
}
