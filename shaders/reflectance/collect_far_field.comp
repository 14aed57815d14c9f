#version 460
#extension GL_GOOGLE_include_directive : require
// Adds the colours of pixels that show no surface, neither to the depth camera nor in the model, to the far field.
#include "lib/camera/camera.glsl"
#include "lib/lighting/far_field.glsl"
#include "shared/fusion/voxel_map.h"

layout(local_size_x = kFarFieldGroup, local_size_y = kFarFieldGroup) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, r32f) uniform readonly image2D depth_m;
layout(binding = 2, rgba16f) uniform readonly image2D color_linear;
layout(std140, binding = 3) uniform Params { FarFieldParams params; };
layout(std430, binding = 4) buffer FarField { FarFieldTexel far_field[]; };

const int kMarginPx = 6;  // around a pixel without a surface, so that it is no rim of one

bool shows_surface(ivec2 pixel) { return imageLoad(position_m, pixel).w > 0.0 || imageLoad(depth_m, pixel).x > 0.0; }

bool is_open(ivec2 pixel) {
    bool open = true;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) open = open && !shows_surface(pixel + kMarginPx * ivec2(x, y));
    return open;
}

void main() {
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, params.visited))) return;
    const uvec2 offset = uvec2(params.phase % params.stride_px, params.phase / params.stride_px);
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy * params.stride_px + offset);
    const ivec2 last = imageSize(depth_m) - 1 - kMarginPx;
    if (any(lessThan(pixel, ivec2(kMarginPx))) || any(greaterThan(pixel, last)) || !is_open(pixel)) return;

    const vec3 direction = to_world_direction(params.depth_camera, unproject(params.depth_camera, vec2(pixel)));
    const vec3 in_color = mat3(params.color_camera.camera_from_world) * direction;
    if (in_color.z < kNearestDepth) return;
    const ivec2 seen_by = ivec2(floor(project(params.color_camera, in_color) + 0.5));
    if (any(lessThan(seen_by, ivec2(0))) || any(greaterThanEqual(seen_by, ivec2(params.color_camera.extent)))) return;
    const vec4 color = imageLoad(color_linear, seen_by);
    if (color.a == 0.0) return;
    const uvec3 steps = uvec3(clamp(color.rgb, 0.0, kColorRange) * kFarFieldSteps + 0.5);
    const uint texel = far_field_texel(direction);
    for (int c = 0; c < 3; ++c) atomicAdd(far_field[texel].sums[c], steps[c]);
    atomicAdd(far_field[texel].sums.w, 1u);
}
