// Smooths depth without mixing surfaces: a bilateral filter whose depth sigma follows the sensor's noise.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/input/filter_depth.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(binding = 1, r32f) uniform writeonly image2D filtered_m;
layout(push_constant) uniform Push { FilterDepthParams params; };

const float kLog2E = 1.44269504;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 last = ivec2(params.extent) - 1;
    if (any(greaterThan(pixel, last))) return;
    const float center_m = imageLoad(depth_m, pixel).x;
    const float sigma_m =
        max(params.sigma_floor_m, center_m * (params.sigma_linear + center_m * params.sigma_quadratic));
    const float depth_exponent = -0.5 * kLog2E / (sigma_m * sigma_m);

    // Sums differences to the centre, which keep their digits where sums of depths would not.
    float weights = 0.0, weighted_m = 0.0;
    [[unroll]] for (int y = -kFilterDepthRadius; y <= kFilterDepthRadius; ++y) {
        [[unroll]] for (int x = -kFilterDepthRadius; x <= kFilterDepthRadius; ++x) {
            const ivec2 wanted = pixel + ivec2(x, y);
            const ivec2 neighbor = clamp(wanted, ivec2(0), last);
            const float neighbor_m = imageLoad(depth_m, neighbor).x;
            const float step_m = neighbor_m - center_m;
            const float exponent = params.spatial_exponent * float(x * x + y * y) + depth_exponent * step_m * step_m;
            const float weight = neighbor == wanted && neighbor_m > 0.0 ? exp2(exponent) : 0.0;
            weights += weight;
            weighted_m += weight * step_m;
        }
    }
    imageStore(filtered_m, pixel, vec4(center_m > 0.0 ? center_m + weighted_m / weights : 0.0));
}
