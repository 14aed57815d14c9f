#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per segment of a batch: what the network says is its material.
#include "lib/lighting/set_material.glsl"
#include "shared/specular/specular_estimates.h"
#include "shared/specular/ward_fit.h"

layout(local_size_x = kBatchGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 1) readonly buffer Estimates { WardMaterial estimates[]; };
layout(std430, binding = 2) buffer Fits { WardFit fits[]; };
layout(std430, binding = 3) buffer Materials { SegmentMaterial materials[]; };
layout(push_constant) uniform Push { ChooseSegmentsParams params; };

void main() {
    const uint segment = gl_GlobalInvocationID.x;
    if (segment >= min(batch[0], params.capacity)) return;
    const uint label = batch[1u + segment];
    const float weight = estimates[label].kd_weight.w;
    if (weight <= 0.0) return;
    fits[label].ks_alpha = estimates[label].ks_alpha;
    fits[label].confidence = weight / kMostEstimateWeight;
    fits[label].diffuse = vec4(estimates[label].kd_weight.rgb, 0.0);
    fits[label].light2 = vec4(1.0);
    if (label < params.materials) materials[label] = changed_material(materials[label], estimates[label].ks_alpha, 0.0);
}
