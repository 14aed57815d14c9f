#version 460
#extension GL_GOOGLE_include_directive : require
// One workgroup per segment: intervals of ks, alpha and kd, from the sums that the Ward fit keeps. First one invocation
// per alpha finds how likely it is; then one per end of an interval looks for it by bisection. Each alpha has two
// components: the ks that its sums show, and, as far as its peak was not seen, any ks. Their widths are what models err
// by, beside noise. Deviations are heavy-tailed (Student's distribution with two degrees of freedom, whose integral has
// a closed form), because most segments are fitted well and some not at all.
#include "lib/brdf/fit_alphas.glsl"
#include "lib/brdf/fit_prior.glsl"
#include "lib/brdf/ward.glsl"
#include "shared/reflectance/reflectance.h"
#include "shared/specular/material_bounds.h"
#include "shared/specular/ward_fit.h"

layout(local_size_x = kBoundsGroup) in;
layout(std430, binding = 0) readonly buffer Fits { WardFit fits[]; };
layout(std430, binding = 1) readonly buffer Curves { FitCurve curves[]; };  // kFitAlphas per label
layout(std430, binding = 2) readonly buffer Albedo { SegmentAlbedo albedo[]; };
layout(std430, binding = 3) writeonly buffer Bounds { MaterialBounds bounds[]; };  // kBoundsLevels per label
layout(push_constant) uniform Push { BoundMaterialsParams params; };

// Without another origin: of most likelihood for the truth of four scenes, seeds 0 to 10 (docs/quality.md,
// "Intervals").
const float kAlphaBefore = 0.4;     // where nobody saw a highlight: the network's word on such segments is no better
const float kAlphaDeviation = 2.0;  // octaves
const float kAlphaError = 0.04;     // octaves
const float kBlurError = 0.048;     // of alpha: highlights are blurred by so much that the fit knows nothing of
const float kSeenVoxels = 2.3;      // near a peak: from so many on it is seen,
const float kMostSeen = 0.83;       // as far as normals are right
const float kKsOffset = 0.003;      // deviations of ks are those of log(ks + kKsOffset):
const float kKsLess = 0.02;         // below what was fitted,
const float kKsMore = 0.035;        // above it,
const float kKsBlurError = 0.6;     // there more by the share of blur, because peaks are cut,
const float kKsUnseen = 0.47;       // and above kKsBefore where nobody saw any; below it more, as there may be none
const float kKsUnseenLess = 1.0;
const float kGlossDoubt = 0.15;    // of the doubt, as a deviation of alpha in octaves, and of log(ks)
const float kKdOffset = 0.0005;    // as kKsOffset
const float kKdError = 0.01;       // relative: of the light
const float kKdDoubt = 1.5;        // of the doubt, as a deviation of log(kd)
const float kKdOfKs = 0.15;        // what kd has of the error of ks where alpha is 1
const float kDoubtOffset = 0.01;   // of kd: the steps of colours
const float kUnknownDoubt = 1.0;   // without a second estimate
const float kHalfKnown = 0.4;      // deviation of log(ks), and of alpha in octaves: of a material that is known half
const float kDullKs = 0.02;        // whose roughness does not matter
const float kMirroredKs = 0.2;     // deviation of log(ks) that mirrored surroundings tell,
const float kMirroredAlpha = 1.0;  // and of their roughness, in octaves: it is assumed

const float kLevels[kBoundsLevels] = float[](0.5, 0.8, 0.9, 0.95);
const uint kEighty = 1u, kNinety = 2u;  // of these
const uint kAlpha = 3u;                 // after the channels of ks
const uint kEnds = 2u * (kAlpha + 1u);  // of a level
const uint kHalvings = 20u;             // to 1e-5 of the range
const float kLeastAlpha = 0.01;

shared float log_fitted[kFitAlphas], log_unseen[kFitAlphas];  // weights of the components, not yet scaled
shared float fitted_weight[kFitAlphas], unseen_weight[kFitAlphas];
shared vec3 center[kFitAlphas];  // log(ks + kKsOffset) of the fitted components
shared vec3 noise[kFitAlphas];   // its deviation
shared float kd_doubt;
shared float low[kBoundsLevels][kAlpha + 1u], high[kBoundsLevels][kAlpha + 1u];

vec3 mean_kd(uint label) {
    return vec3(albedo[label].kd.rgb) / (max(vec3(albedo[label].weight.rgb), 1.0) * kAlbedoSteps);
}

bool kd_is_known(uint label) {
    const uvec4 weight = albedo[label].weight;
    return min(min(weight.r, weight.g), weight.b) >= kLeastSegmentWeight * kCertaintySteps;
}

// How far two estimates of one albedo are apart, which weigh the same colours differently: the mean over voxels, and
// the one albedo of least squares, in which brightly lit voxels count for more. Where light, surface or segment are
// wrong, they disagree: a lamp that was not found shows. The mean over channels of |log(kd / kd')|.
float doubt_of_kd(uint label, WardFit fit) {
    if (!kd_is_known(label) || min(min(fit.light2.r, fit.light2.g), fit.light2.b) <= 0.0) return kUnknownDoubt;
    const vec3 squares = clamp(fit.diffuse.rgb / fit.light2.rgb, 0.0, 1.0);
    return dot(abs(log((mean_kd(label) + kDoubtOffset) / (squares + kDoubtOffset))), vec3(1.0 / 3.0));
}

float below(float x, float middle, float less, float more) {
    const float z = (x - middle) / (x < middle ? less : more);
    return 0.5 + 0.5 * z * inversesqrt(2.0 + z * z);
}

// The share of highlights' width that may be blur.
float blur_share(uint a) {
    const float share = kBlurError / fit_alpha(float(a));
    return share * share;
}

void weigh_alpha(uint a, FitSums sums, float deviation) {
    const float alpha = fit_alpha(float(a)), scale = ward_scale(alpha);
    const float unit = kCorrelated * deviation * deviation, prior = unit / (kKsDeviation * kKsDeviation);
    const vec3 lobe2 = scale * scale * sums.lobe2.rgb, product = scale * sums.product.rgb;
    const vec3 stiffness = lobe2 + prior;
    const vec3 ks = max((product + prior * kKsBefore) / stiffness, 0.0), off = ks - kKsBefore;
    // Against no highlight at all, integrated over ks.
    const vec3 evidence = (2.0 * ks * product - ks * ks * lobe2 - prior * off * off) / unit - log(stiffness / prior);
    const float octaves = log2(alpha / kAlphaBefore) / kAlphaDeviation;
    const float before = -0.5 * octaves * octaves, seen = kMostSeen * min(sums.lobe2.w / kSeenVoxels, 1.0);
    log_fitted[a] = before + log(max(seen, 1e-12)) + 0.5 * dot(evidence, vec3(1.0));
    log_unseen[a] = before + log(1.0 - seen);
    center[a] = log(ks + kKsOffset);
    noise[a] = min(sqrt(unit / stiffness) / (ks + kKsOffset), kKsUnseen);
}

void scale_weights(uint a) {
    float most = -1e30, sum = 0.0;
    for (uint i = 0u; i < kFitAlphas; ++i) most = max(most, max(log_fitted[i], log_unseen[i]));
    for (uint i = 0u; i < kFitAlphas; ++i) sum += exp(log_fitted[i] - most) + exp(log_unseen[i] - most);
    fitted_weight[a] = exp(log_fitted[a] - most) / sum;
    unseen_weight[a] = exp(log_unseen[a] - most) / sum;
}

float ks_below(uint channel, float x) {
    float sum = 0.0, unseen = 0.0;
    const float doubt = kGlossDoubt * kd_doubt;
    for (uint a = 0u; a < kFitAlphas; ++a) {
        const float own = noise[a][channel], blur = kKsBlurError * blur_share(a), common2 = own * own + doubt * doubt;
        const float less = sqrt(kKsLess * kKsLess + common2), more = sqrt(kKsMore * kKsMore + blur * blur + common2);
        sum += fitted_weight[a] * below(x, center[a][channel], less, more);
        unseen += unseen_weight[a];
    }
    return sum + unseen * below(x, log(kKsBefore + kKsOffset), kKsUnseenLess, kKsUnseen);
}

float alpha_below(float x) {
    float sum = 0.0;
    const float doubt = kGlossDoubt * kd_doubt, more2 = kAlphaError * kAlphaError + doubt * doubt;
    for (uint a = 0u; a < kFitAlphas; ++a) {
        const float blur = blur_share(a);
        const float weight = fitted_weight[a] + unseen_weight[a];
        sum += weight * below(x, log2(fit_alpha(float(a))), sqrt(more2 + blur * blur), sqrt(more2));
    }
    return sum;
}

// Below which value a parameter lies with probability p.
float quantile(uint parameter, float p) {
    const bool is_alpha = parameter == kAlpha;
    float least = is_alpha ? log2(kLeastAlpha) : log(kKsOffset), most = is_alpha ? 0.0 : log(1.0 + kKsOffset);
    for (uint i = 0u; i < kHalvings; ++i) {
        const float middle = 0.5 * (least + most);
        const bool less = (is_alpha ? alpha_below(middle) : ks_below(parameter, middle)) < p;
        least = less ? middle : least;
        most = less ? most : middle;
    }
    const float x = 0.5 * (least + most);
    return is_alpha ? exp2(x) : max(exp(x) - kKsOffset, 0.0);
}

// Deviations from the middle of Student's distribution.
float deviations(float level) { return level * sqrt(2.0 / (1.0 - level * level)); }

// Of what mirrored surroundings tell.
float mirrored_end(uint parameter, float value, float level) {
    const float away = deviations(level);
    return min(value * (parameter == kAlpha ? exp2(kMirroredAlpha * away) : exp(kMirroredKs * away)), 1.0);
}

// Intervals hold what was estimated.
void find_end(uint lane, WardFit fit) {
    const uint level = lane / kEnds, parameter = lane % kEnds / 2u;
    if (level >= kBoundsLevels) return;
    const bool is_high = lane % 2u == 1u, is_mirrored = fit.mirrored.w > 0.0;
    const float share = (is_high ? 0.5 : -0.5) * kLevels[level];
    const float value = is_mirrored ? fit.mirrored[parameter] : fit.ks_alpha[parameter];
    const float end = is_mirrored ? mirrored_end(parameter, value, 2.0 * share) : quantile(parameter, 0.5 + share);
    if (is_high) {
        high[level][parameter] = max(end, value);
    } else {
        low[level][parameter] = min(end, value);
    }
}

vec4 low_of(uint level) { return vec4(low[level][0], low[level][1], low[level][2], low[level][kAlpha]); }
vec4 high_of(uint level) { return vec4(high[level][0], high[level][1], high[level][2], high[level][kAlpha]); }

// How sure ks is, and alpha where there is a highlight: never more than the fit is.
float confidence_of(WardFit fit) {
    const vec4 least = low_of(kNinety), most = high_of(kNinety);
    const float scale = 0.5 / deviations(kLevels[kNinety]);
    const vec3 ks = scale * log((most.rgb + kKsOffset) / (least.rgb + kKsOffset)) / kHalfKnown;
    const float alpha = scale * log2(most.w / least.w) / kHalfKnown;
    const bool dull = max(max(most.r, most.g), most.b) < kDullKs;
    if (fit.mirrored.w > 0.0) return 1.0 / (1.0 + dot(ks, ks) / 3.0);
    return min(fit.confidence, 1.0 / ((1.0 + dot(ks, ks) / 3.0) * (dull ? 1.0 : 1.0 + alpha * alpha)));
}

// Of log(kd + kKdOffset): light errs in proportion, and kd has what ks has too little of, the more the broader
// highlights are.
vec3 kd_deviation(vec3 kd, float alpha) {
    const float scale = 0.5 / deviations(kLevels[kEighty]), of_doubt = kKdDoubt * kd_doubt;
    const vec3 of_ks = kKdOfKs * alpha * scale * (high_of(kEighty).rgb - low_of(kEighty).rgb);
    const vec3 of_light = kKdError * kd;
    return sqrt((of_light * of_light + of_ks * of_ks) / ((kd + kKdOffset) * (kd + kKdOffset)) + of_doubt * of_doubt);
}

void write_level(uint label, uint level, WardFit fit) {
    const bool known = kd_is_known(label);
    const vec3 kd = mean_kd(label);
    const vec3 factor = exp(deviations(kLevels[level]) * kd_deviation(kd, fit.ks_alpha.w));
    const vec3 kd_low = known ? max((kd + kKdOffset) / factor - kKdOffset, 0.0) : vec3(0.0);
    const vec3 kd_high = known ? min((kd + kKdOffset) * factor - kKdOffset, 1.0) : vec3(1.0);
    bounds[label * kBoundsLevels + level] =
        MaterialBounds(vec4(kd_low, confidence_of(fit)), vec4(kd_high, 0.0), low_of(level), high_of(level));
}

void main() {
    const uint label = gl_WorkGroupID.y * kBoundsRow + gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    if (label >= params.labels || label >= uint(albedo.length()) || albedo[label].kd.w == 0u) return;
    const WardFit fit = fits[label];
    if (lane < kFitAlphas) {
        FitSums sums = FitSums(vec4(0.0), vec4(0.0), vec4(0.0));
        if (fit.estimates > 0u) sums = curves[label * kFitAlphas + lane].sums;
        weigh_alpha(lane, sums, max(fit.deviation, kLeastDeviation));
    }
    if (lane == 0u) kd_doubt = doubt_of_kd(label, fit);
    barrier();
    if (lane < kFitAlphas) scale_weights(lane);
    barrier();
    find_end(lane, fit);
    barrier();
    if (lane < kBoundsLevels) write_level(label, lane, fit);
}
