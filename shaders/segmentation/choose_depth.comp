// The model's depth where there is one, else the reading.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/frame_surface.glsl"

layout(local_size_x = 32, local_size_y = 4) in;
layout(binding = 0, rgba32f) uniform readonly image2D model_position_m;  // w: depth, 0 where nothing was hit
layout(binding = 1, r32f) uniform readonly image2D reading_m;
layout(binding = 2, r32f) uniform writeonly image2D depth_m;
layout(push_constant) uniform Push { FrameSurfaceParams params; };

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    const float model = imageLoad(model_position_m, pixel).w;
    const float reading = imageLoad(reading_m, pixel).x;
    imageStore(depth_m, pixel, vec4(model > 0.0 ? model : reading));
}
