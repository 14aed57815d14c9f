#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Packs what a camera sees of the model, or means of 2 x 2 pixels of one surface: depth, normal, shade and how the
// shade changes.
#include "lib/camera/camera.glsl"
#include "lib/tracking/track_pixels.glsl"

layout(local_size_x = kTrackGroupX, local_size_y = kTrackGroupY) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(binding = 2, rgba16f) uniform readonly image2D color_linear;
layout(binding = 3, rgba32ui) uniform writeonly uimage2D packed;
layout(push_constant) uniform Push { PackModelParams params; };

layout(constant_id = 0) const int kSide = 1;  // 2: means of 2 x 2

// Of the pixel's kSide x kSide source pixels and of those around; [1][1] is its first. Shades below 0 are not known.
float depths[4][4];
float shades[4][4];

void load_sources(ivec2 first) {
    [[unroll]] for (int y = 0; y < kSide + 2; ++y) {
        [[unroll]] for (int x = 0; x < kSide + 2; ++x) {
            const ivec2 source = first + ivec2(x, y) - 1;
            depths[y][x] = imageLoad(position_m, source).w;
            const vec4 color = imageLoad(color_linear, source);
            shades[y][x] = color.a > 0.0 ? shade_of(color.rgb) : -1.0;
        }
    }
}

// Below 0 where it is not known, or the surface there does not continue the one at depth z.
float shade_beside(int x, int y, float z) {
    return abs(depths[y][x] - z) <= params.jump_m + params.jump_slope * z ? shades[y][x] : -1.0;
}

void add_shade(inout ModelPixel found, int x, int y) {
    const float z = found.depth_m;
    const vec4 beside = vec4(shade_beside(x - 1, y, z), shade_beside(x + 1, y, z),  //
                             shade_beside(x, y - 1, z), shade_beside(x, y + 1, z));
    const bool known = shades[y][x] >= 0.0 && all(greaterThanEqual(beside, vec4(0.0)));
    found.shade = known ? shades[y][x] : -1.0;
    found.shade_per_px = known ? 0.5 * (beside.yw - beside.xz) : vec2(0.0);
}

ModelPixel source_pixel(ivec2 first, int x, int y) {
    const ivec2 source = first + ivec2(x, y) - 1;
    const float z = depths[y][x];
    const vec3 n = mat3(params.camera.camera_from_world) * imageLoad(normal, source).xyz;
    const vec3 ray = unproject(params.camera, vec2(source));
    ModelPixel found = ModelPixel(z, n, vec2(0.0), -1.0);
    if (params.shaded != 0u) add_shade(found, x, y);
    const bool seen = z > 0.0 && -dot(n, ray) >= params.least_cosine * length(ray);
    return seen ? found : no_model_pixel();
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(packed)))) return;
    const ivec2 first = kSide * pixel;
    load_sources(first);
    if (kSide == 1) {
        imageStore(packed, pixel, pack_model_pixel(source_pixel(first, 1, 1)));
        return;
    }
    ModelMean sums = begin_mean();
    [[unroll]] for (int y = 1; y <= 2; ++y) {
        [[unroll]] for (int x = 1; x <= 2; ++x) add_to_mean(sums, source_pixel(first, x, y));
    }
    imageStore(packed, pixel, pack_model_pixel(end_mean(sums, params.jump_m, 2.0 * params.jump_slope)));
}
