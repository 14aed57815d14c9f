#version 460
#extension GL_GOOGLE_include_directive : require
// Leaves out the model's colours where its re-rendering is a highlight to a good part: it moves with the camera.
#include "lib/color/luminance.glsl"
#include "shared/tracking/tracking.h"

layout(local_size_x = kTrackGroupX, local_size_y = kTrackGroupY) in;
layout(binding = 0, rgba16f) uniform readonly image2D color_linear;
layout(binding = 1, rgba16f) uniform readonly image2D kd;     // a = 1 where it is known
layout(binding = 2, rgba16f) uniform readonly image2D light;  // what kd multiplies in rgb
layout(binding = 3, rgba16f) uniform readonly image2D rgb;
layout(binding = 4, rgba16f) uniform writeonly image2D matte;
layout(push_constant) uniform Push { HideHighlightsParams params; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    const vec4 known = imageLoad(kd, pixel), color = imageLoad(color_linear, pixel);
    const float all = luminance(imageLoad(rgb, pixel).rgb);
    const float diffuse = luminance(known.rgb * imageLoad(light, pixel).rgb);
    const bool highlight = known.a > 0.0 && all - diffuse > params.most_share * all;
    imageStore(matte, pixel, highlight ? vec4(0.0) : color);
}
