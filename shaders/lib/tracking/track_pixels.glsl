// Packing of the frame's and the model's pixels (shared/tracking/tracking.h). Functions without bindings.
#ifndef PATINA_LIB_TRACK_PIXELS_GLSL
#define PATINA_LIB_TRACK_PIXELS_GLSL
#include "lib/color/luminance.glsl"
#include "shared/tracking/tracking.h"

const float kMostShade = float(kNoShade - 1u) / kShadeUnits;

// Even in a camera's noise; below 0 for no shade.
float shade_of(vec3 linear) { return min(sqrt(max(luminance(linear), 0.0)), kMostShade); }

// A reading of the frame; depth 0: none; shade below 0: none.
uint pack_frame_pixel(float depth_m, float shade) {
    const uint depth = min(uint(round(max(depth_m, 0.0) * kDepthUnitsPerMetre)), kMostDepthUnits);
    return depth | (shade < 0.0 ? kNoShade : min(uint(round(shade * kShadeUnits)), kNoShade - 1u)) << 20;
}
float frame_depth_m(uint pixel) { return float(pixel & kMostDepthUnits) * (1.0 / kDepthUnitsPerMetre); }
bool frame_has_shade(uint pixel) { return pixel >> 20 != kNoShade; }
float frame_shade(uint pixel) { return float(pixel >> 20) * (1.0 / kShadeUnits); }

// A pixel of the model in 128 bits: depth, 0 where there is none; then 16 bits each: normal in camera coordinates;
// shade, below 0 where it or its change is not known; how the shade changes per pixel in x and y. Three coordinates of
// the normal, as an octahedral one takes a square root to unpack.
struct ModelPixel {
    float depth_m;
    vec3 normal;
    vec2 shade_per_px;
    float shade;
};
uint low_and_high(ivec2 parts) { return (uint(parts.x) & 0xffffu) | uint(parts.y) << 16; }
float low_part(uint word) { return float(int(word << 16) >> 16); }
float high_part(uint word) { return float(int(word) >> 16); }

uvec4 pack_model_pixel(ModelPixel pixel) {
    const ivec3 normal = ivec3(round(clamp(pixel.normal, -1.0, 1.0) * 32767.0));
    const float shade = pixel.shade < 0.0 ? -1.0 : round(min(pixel.shade, kMostShade) * kModelShadeUnits);
    const ivec2 change = ivec2(round(clamp(pixel.shade_per_px, -1.0, 1.0) * 32767.0));
    return uvec4(floatBitsToUint(pixel.depth_m), low_and_high(normal.xy), low_and_high(ivec2(normal.z, shade)),
                 low_and_high(change));
}
ModelPixel unpack_model_pixel(uvec4 packed) {
    const vec3 normal = vec3(low_part(packed.y), high_part(packed.y), low_part(packed.z)) * (1.0 / 32767.0);
    const vec2 change = vec2(low_part(packed.w), high_part(packed.w)) * (1.0 / 32767.0);
    return ModelPixel(uintBitsToFloat(packed.x), normal, change, high_part(packed.z) * (1.0 / kModelShadeUnits));
}
ModelPixel no_model_pixel() { return ModelPixel(0.0, vec3(0.0, 0.0, -1.0), vec2(0.0), -1.0); }

// The mean of 2 x 2 pixels of one surface.
struct ModelMean {
    ModelPixel mean;  // the normal is the sum of four
    float nearest_m;
    float farthest_m;
    float least_shade;
};
ModelMean begin_mean() { return ModelMean(ModelPixel(0.0, vec3(0.0), vec2(0.0), 0.0), 1e9, 0.0, 1e9); }
void add_to_mean(inout ModelMean sums, ModelPixel part) {
    sums.nearest_m = min(sums.nearest_m, part.depth_m);
    sums.farthest_m = max(sums.farthest_m, part.depth_m);
    sums.least_shade = min(sums.least_shade, part.shade);
    sums.mean.depth_m += 0.25 * part.depth_m;
    sums.mean.normal += part.normal;
    // Twice the mean: a pixel is twice as wide.
    sums.mean.shade_per_px += 0.5 * part.shade_per_px;
    sums.mean.shade += 0.25 * part.shade;
}
// None where a pixel has nothing, or they lie on different surfaces.
ModelPixel end_mean(ModelMean sums, float jump_m, float jump_slope) {
    const bool known = sums.nearest_m > 0.0 &&
                       sums.farthest_m - sums.nearest_m <= jump_m + jump_slope * sums.nearest_m &&
                       dot(sums.mean.normal, sums.mean.normal) > 8.0;
    ModelPixel mean = sums.mean;
    mean.normal = normalize(mean.normal);
    mean.shade = sums.least_shade < 0.0 ? -1.0 : mean.shade;
    mean.shade_per_px = sums.least_shade < 0.0 ? vec2(0.0) : mean.shade_per_px;
    return known ? mean : no_model_pixel();
}

#endif
