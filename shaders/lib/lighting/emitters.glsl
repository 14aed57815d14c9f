// Which pixels shine. The includer declares, before it includes this,
//   layout(rgba16f, binding = n) uniform readonly image2D color;
//   layout(std140, binding = n) uniform Params { FindLightsParams params; };
#ifndef PATINA_LIB_EMITTERS_GLSL
#define PATINA_LIB_EMITTERS_GLSL
#include "lib/color/luminance.glsl"
#include "shared/input/convert_color.h"

// The pixel with the given number in the picture's order; whether it shines. A pixel that is not valid does not.
bool shines(uint index, out ivec2 pixel, out vec4 value) {
    const uvec2 extent = params.camera.extent;
    pixel = ivec2(index % extent.x, index / extent.x);
    value = vec4(0.0);
    if (index >= extent.x * extent.y) return false;
    value = imageLoad(color, pixel);
    return value.a != kColorInvalid && luminance(value.rgb) >= params.threshold;
}

#endif
