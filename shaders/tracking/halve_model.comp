#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The next coarser level of the model: the mean of 2 x 2 pixels of one surface.
#include "lib/track_pixels.glsl"

layout(local_size_x = kTrackGroupX, local_size_y = kTrackGroupY) in;
layout(binding = 0, rgba32ui) uniform readonly uimage2D fine;
layout(binding = 1, rgba32ui) uniform writeonly uimage2D coarse;
layout(push_constant) uniform Push { HalveParams params; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    float nearest = 1e9, farthest = 0.0, least_shade = 1e9;
    ModelPixel mean = ModelPixel(0.0, vec3(0.0), vec2(0.0), 0.0);
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const ModelPixel part = unpack_model_pixel(imageLoad(fine, 2 * pixel + ivec2(i & 1, i >> 1)));
        nearest = min(nearest, part.depth_m);
        farthest = max(farthest, part.depth_m);
        least_shade = min(least_shade, part.shade);
        mean.depth_m += 0.25 * part.depth_m;
        mean.normal += part.normal;
        // Twice the mean: a pixel is twice as wide.
        mean.shade_per_px += 0.5 * part.shade_per_px;
        mean.shade += 0.25 * part.shade;
    }
    const bool known = nearest > 0.0 && farthest - nearest <= params.jump_m + params.jump_slope * nearest &&
                       dot(mean.normal, mean.normal) > 8.0;
    const ModelPixel none = ModelPixel(0.0, vec3(0.0, 0.0, -1.0), vec2(0.0), -1.0);
    mean.normal = normalize(mean.normal);
    if (least_shade < 0.0) {
        mean.shade = -1.0;
        mean.shade_per_px = vec2(0.0);
    }
    imageStore(coarse, pixel, pack_model_pixel(known ? mean : none));
}
