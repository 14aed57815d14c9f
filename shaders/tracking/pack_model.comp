#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Packs every stride-th pixel of what a camera sees of the model: depth, normal, shade and how the shade changes.
#include "lib/camera.glsl"
#include "lib/track_pixels.glsl"

layout(local_size_x = kTrackGroupX, local_size_y = kTrackGroupY) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(binding = 2, rgba16f) uniform readonly image2D color_linear;
layout(binding = 3, rgba32ui) uniform writeonly uimage2D packed;
layout(push_constant) uniform Push { PackModelParams params; };

// Of a pixel whose surface continues the one at depth z; below 0 where it is not known.
float shade_beside(ivec2 pixel, float z) {
    const vec4 color = imageLoad(color_linear, pixel);
    const float there = imageLoad(position_m, pixel).w;
    const float reach = float(params.reach);
    const bool known = color.a > 0.0 && abs(there - z) <= params.jump_m + reach * params.jump_slope * z;
    return known ? shade_of(color.rgb) : -1.0;
}

void add_shade(inout ModelPixel found, ivec2 source) {
    const int r = params.reach;
    const float z = found.depth_m, here = shade_beside(source, z);
    const vec4 beside = vec4(shade_beside(source - ivec2(r, 0), z), shade_beside(source + ivec2(r, 0), z),
                             shade_beside(source - ivec2(0, r), z), shade_beside(source + ivec2(0, r), z));
    if (here < 0.0 || any(lessThan(beside, vec4(0.0)))) return;
    found.shade = here;
    found.shade_per_px = (beside.yw - beside.xz) * (float(params.stride) / float(2 * r));
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.extent)))) return;
    const ivec2 source = params.stride * pixel + params.stride / 2;
    const float z = imageLoad(position_m, source).w;
    const vec3 n = mat3(params.camera.camera_from_world) * imageLoad(normal, source).xyz;
    const vec3 ray = unproject(params.camera, vec2(source));
    const bool seen = z > 0.0 && -dot(n, ray) >= params.least_cosine * length(ray);
    ModelPixel found = ModelPixel(0.0, vec3(0.0, 0.0, -1.0), vec2(0.0), -1.0);
    if (seen) {
        found.depth_m = z;
        found.normal = n;
        if (params.shaded != 0u) add_shade(found, source);
    }
    imageStore(packed, pixel, pack_model_pixel(found));
}
