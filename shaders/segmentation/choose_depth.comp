// The model's depth where there is one, else the reading, and the chromaticity that the colour camera saw there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/color/chroma.glsl"
#include "shared/input/choose_depth.h"
#include "shared/input/convert_color.h"

layout(constant_id = 0) const int kStride = 1;  // of the pixels in x and y
layout(local_size_x = 128) in;                  // of one row: software devices take a group of several rows longer
layout(binding = 0, rgba32f) uniform readonly image2D model_position_m;  // w: depth, 0 where nothing was hit
layout(binding = 1, r32f) uniform readonly image2D reading_m;
layout(binding = 2, rgba16f) uniform readonly image2D color_linear;
layout(binding = 3, r32f) uniform writeonly image2D depth_m;
layout(binding = 4, r32ui) uniform writeonly uimage2D chroma;
layout(push_constant) uniform Push { ChooseDepthParams params; };

void main() {
    const ivec2 sampled = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 pixel = sampled * kStride;
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    const float model = imageLoad(model_position_m, pixel).w;
    const float reading = imageLoad(reading_m, pixel).x;
    const float z = model > 0.0 ? model : reading;
    imageStore(depth_m, sampled, vec4(z));

    const vec2 ray = (vec2(pixel) - params.depth_focal_center_px.zw) / params.depth_focal_center_px.xy;
    const vec3 at = (params.color_from_depth * vec4(ray * z, z, 1.0)).xyz;
    const vec2 place = at.xy / max(at.z, 1e-3) * params.color_focal_center_px.xy + params.color_focal_center_px.zw;
    // Outside the image loads are zero: no colour.
    const vec4 seen = imageLoad(color_linear, ivec2(floor(place + 0.5)));
    const bool known = z > 0.0 && at.z > 0.0 && seen.a >= kColorValid;
    imageStore(chroma, sampled, uvec4(known ? pack_chroma(seen.rgb) : 0u));
}
