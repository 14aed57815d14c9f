// Packing of the frame's and the model's pixels (shared/tracking.h). Functions without bindings.
#ifndef PATINA_LIB_TRACK_PIXELS_GLSL
#define PATINA_LIB_TRACK_PIXELS_GLSL
#include "lib/luminance.glsl"
#include "lib/octahedral.glsl"
#include "shared/tracking.h"

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

// A pixel of the model in 128 bits: depth, 0 where there is none; normal in camera coordinates, octahedral; how the
// shade changes per pixel in x and y; shade, below 0 where it or its change is not known.
struct ModelPixel {
    float depth_m;
    vec3 normal;
    vec2 shade_per_px;
    float shade;
};
uvec4 pack_model_pixel(ModelPixel pixel) {
    return uvec4(floatBitsToUint(pixel.depth_m), packSnorm2x16(to_octahedral(pixel.normal)),
                 packSnorm2x16(pixel.shade_per_px), floatBitsToUint(pixel.shade));
}
ModelPixel unpack_model_pixel(uvec4 packed) {
    return ModelPixel(uintBitsToFloat(packed.x), from_octahedral(unpackSnorm2x16(packed.y)), unpackSnorm2x16(packed.z),
                      uintBitsToFloat(packed.w));
}

#endif
