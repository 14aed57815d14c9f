#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The next coarser level of a frame: the mean of 2 x 2 pixels of one surface.
#include "lib/tracking/track_pixels.glsl"

layout(local_size_x = kTrackGroupX, local_size_y = kTrackGroupY) in;
layout(binding = 0, r32ui) uniform readonly uimage2D fine;
layout(binding = 1, r32ui) uniform writeonly uimage2D coarse;
layout(push_constant) uniform Push { HalveParams params; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    float depths = 0.0, depth_sum = 0.0, nearest = 1e9, farthest = 0.0, shades = 0.0, shade_sum = 0.0;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const uint part = imageLoad(fine, 2 * pixel + ivec2(i & 1, i >> 1)).x;
        const float z = frame_depth_m(part);
        const bool reading = z > 0.0, shaded = reading && frame_has_shade(part);
        depths += reading ? 1.0 : 0.0;
        depth_sum += z;
        nearest = reading ? min(nearest, z) : nearest;
        farthest = max(farthest, z);
        shades += shaded ? 1.0 : 0.0;
        shade_sum += shaded ? frame_shade(part) : 0.0;
    }
    // One may be missing: its absence moves the mean by a quarter of a pixel.
    const bool known = depths >= 3.0 && farthest - nearest <= params.jump_m + params.jump_slope * nearest;
    imageStore(coarse, pixel,
               uvec4(pack_frame_pixel(known ? depth_sum / depths : 0.0, shades >= 3.0 ? shade_sum / shades : -1.0)));
}
