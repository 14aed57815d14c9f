// What is known of the specular materials of segments. See passes/state/specular_estimates.h.
#ifndef PATINA_SHARED_SPECULAR_ESTIMATES_H
#define PATINA_SHARED_SPECULAR_ESTIMATES_H
#include "shared/specular/hemi_images.h"
#include "shared/specular/segment_batch.h"
INTEROP_BEGIN

INTEROP_CONST float kMostEstimateWeight = 60.0f;  // of the estimates so far (paper, Section 3.6)

// The perceptual parameters w of a material, lib/color/perceptual.glsl, in the order of the network's outputs.
struct PerceptualMaterial {
    vec4 lab_cr;        // L, a, b, over 100; c_r
    vec4 cgb_d_weight;  // c_g, c_b; d; weight of a mean, 0: none. The network leaves it undefined
};

// The same as Ward's parameters.
struct WardMaterial {
    vec4 kd_weight;  // rgb; weight, as above
    vec4 ks_alpha;   // rgb, roughness
};

struct FuseEstimatesParams {
    uint capacity;  // segments of the batch
    uint labels;    // of the table
    float weight;   // of an estimate
};

struct PerceptualParams {
    uint count;
};

INTEROP_END
#endif
