#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per segment of a batch: the new estimate joins the mean of those before (paper, Section 3.6).
#include "lib/color/perceptual.glsl"

layout(local_size_x = kBatchGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 1) readonly buffer Drawn { uint drawn[]; };  // kHemiSamples per segment
layout(std430, binding = 2) readonly buffer Estimates { PerceptualMaterial estimates[]; };
layout(std430, binding = 3) buffer Means { PerceptualMaterial means[]; };
layout(std430, binding = 4) writeonly buffer Materials { WardMaterial materials[]; };
layout(push_constant) uniform Push { FuseEstimatesParams params; };

bool is_finite(vec4 v) { return !any(isnan(v)) && !any(isinf(v)); }

void main() {
    const uint segment = gl_GlobalInvocationID.x;
    if (segment >= min(batch[0], params.capacity)) return;
    const uint label = batch[1u + segment];
    const vec4 lab_cr = estimates[segment].lab_cr, cgb_d = vec4(estimates[segment].cgb_d_weight.xyz, 0.0);
    if (label >= params.labels || drawn[segment * kHemiSamples] == kNoRecord) return;
    // Colours may be wild; a mean would never forget one that is no number.
    if (!is_finite(lab_cr) || !is_finite(cgb_d)) return;
    PerceptualMaterial mean = means[label];
    const float weight = mean.cgb_d_weight.w, sum = weight + params.weight, share = params.weight / sum;
    mean.lab_cr = mix(mean.lab_cr, lab_cr, share);
    mean.cgb_d_weight = vec4(mix(mean.cgb_d_weight.xyz, cgb_d.xyz, share), min(sum, kMostEstimateWeight));
    means[label] = mean;
    materials[label] = material_of(mean);
}
