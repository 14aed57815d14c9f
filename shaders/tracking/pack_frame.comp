#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Packs the frame's readings, or means of 2 x 2 of one surface, with the shade of what they show. Readings beside a
// jump in depth, which may fly between two surfaces, are left out.
#include "lib/camera/camera.glsl"
#include "lib/tracking/track_pixels.glsl"
#include "shared/input/convert_color.h"

layout(local_size_x = kTrackGroupX, local_size_y = kTrackGroupY) in;
layout(binding = 0, r32f) uniform readonly image2D depth_m;
layout(binding = 1, rgba16f) uniform readonly image2D color_linear;
layout(binding = 2, r32ui) uniform writeonly uimage2D packed;
layout(push_constant) uniform Push { PackFrameParams params; };

layout(constant_id = 0) const int kSide = 1;  // 2: means of 2 x 2

float depths[4][4];  // of the pixel's kSide x kSide readings and of those around; [1][1] is its first

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

void load_depths(ivec2 first) {
    const ivec2 last = imageSize(depth_m) - 1;
    [[unroll]] for (int y = 0; y < kSide + 2; ++y) {
        [[unroll]] for (int x = 0; x < kSide + 2; ++x) depths[y][x] =
            imageLoad(depth_m, clamp(first + ivec2(x, y) - 1, ivec2(0), last)).x;
    }
}

bool continues(float z, float there) { return there == 0.0 || abs(there - z) <= params.jump_m + params.jump_slope * z; }

// 0 where there is none, or it lies beside a jump.
float reading(int x, int y) {
    const float z = depths[y][x];
    const bool whole = continues(z, depths[y][x - 1]) && continues(z, depths[y][x + 1]) &&
                       continues(z, depths[y - 1][x]) && continues(z, depths[y + 1][x]);
    return whole && z <= params.max_depth_m ? max(z, 0.0) : 0.0;
}

// Of the kSide x kSide readings; one may be missing: its absence moves the mean by a quarter of a pixel.
float mean_reading() {
    float known = 0.0, sum = 0.0, nearest = 1e9, farthest = 0.0;
    [[unroll]] for (int y = 1; y <= kSide; ++y) {
        [[unroll]] for (int x = 1; x <= kSide; ++x) {
            const float z = reading(x, y);
            known += z > 0.0 ? 1.0 : 0.0;
            sum += z;
            nearest = z > 0.0 ? min(nearest, z) : nearest;
            farthest = max(farthest, z);
        }
    }
    const bool one_surface = farthest - nearest <= params.jump_m + float(kSide) * params.jump_slope * nearest;
    return known >= float(kSide * kSide) * 0.75 && one_surface ? sum / known : 0.0;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(packed)))) return;
    load_depths(kSide * pixel);
    const float z = mean_reading();
    float shade = -1.0;
    if (params.shaded != 0u && z > 0.0) {
        const vec2 center = vec2(kSide * pixel) + 0.5 * float(kSide - 1);
        const vec3 point = vec3((center - params.focal_center_px.zw) / params.focal_center_px.xy, 1.0) * z;
        const vec3 seen = to_camera(params.color_camera, point);
        if (seen.z > 0.0) shade = shade_at(project(params.color_camera, seen));
    }
    imageStore(packed, pixel, uvec4(pack_frame_pixel(z, shade)));
}
