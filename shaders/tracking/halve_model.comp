#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The next coarser level of the model: the mean of 2 x 2 pixels of one surface.
#include "lib/tracking/track_pixels.glsl"

layout(local_size_x = kTrackGroupX, local_size_y = kTrackGroupY) in;
layout(binding = 0, rgba32ui) uniform readonly uimage2D fine;
layout(binding = 1, rgba32ui) uniform writeonly uimage2D coarse;
layout(push_constant) uniform Push { HalveParams params; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    ModelMean sums = begin_mean();
    [[unroll]] for (int i = 0; i < 4; ++i)
        add_to_mean(sums, unpack_model_pixel(imageLoad(fine, 2 * pixel + ivec2(i & 1, i >> 1))));
    imageStore(coarse, pixel, pack_model_pixel(end_mean(sums, params.jump_m, params.jump_slope)));
}
