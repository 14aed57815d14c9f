#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Packs the frame's readings with the shade of what they show. Readings beside a jump in depth, which may fly between
// two surfaces, are left out.
#include "lib/camera.glsl"
#include "lib/track_pixels.glsl"
#include "shared/convert_color.h"

layout(local_size_x = kTrackGroupX, local_size_y = kTrackGroupY) in;
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(binding = 1, rgba16f) uniform readonly image2D color_linear;
layout(binding = 2, r32ui) uniform writeonly uimage2D packed;
layout(push_constant) uniform Push { PackFrameParams params; };

// Between four pixels; below 0 where one of these is not known.
float shade_at(vec2 pixel) {
    const vec2 low = floor(pixel), t = pixel - low;
    float shade = 0.0, least = kColorValid;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const ivec2 corner = ivec2(i & 1, i >> 1);
        const vec2 share = mix(1.0 - t, t, vec2(corner));
        const float weight = share.x * share.y;
        const vec4 color = imageLoad(color_linear, ivec2(low) + corner);
        shade += weight * shade_of(color.rgb);
        least = weight > 1e-3 ? min(least, color.a) : least;
    }
    return least == kColorValid ? shade : -1.0;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 last = imageSize(depth_m) - 1;
    if (any(greaterThan(pixel, last))) return;
    const float z = imageLoad(depth_m, pixel).x;
    bool whole = z > 0.0 && z <= params.max_depth_m;
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const ivec2 side = i < 2 ? ivec2(2 * i - 1, 0) : ivec2(0, 2 * i - 5);
        const float there = imageLoad(depth_m, clamp(pixel + side, ivec2(0), last)).x;
        whole = whole && (there == 0.0 || abs(there - z) <= params.jump_m + params.jump_slope * z);
    }
    float shade = -1.0;
    if (params.shaded != 0u && whole) {
        const vec3 point = vec3((vec2(pixel) - params.focal_center_px.zw) / params.focal_center_px.xy, 1.0) * z;
        const vec3 seen = to_camera(params.color_camera, point);
        if (seen.z > 0.0) shade = shade_at(project(params.color_camera, seen));
    }
    imageStore(packed, pixel, uvec4(pack_frame_pixel(whole ? z : 0.0, shade)));
}
