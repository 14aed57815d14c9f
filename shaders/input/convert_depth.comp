// Turns a depth picture as the sensor gave it into metres as a pinhole camera would see them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera/lens.glsl"
#include "shared/input/convert_depth.h"

layout(local_size_x = 32, local_size_y = 4) in;
layout(constant_id = 0) const bool kMetres = false;     // the source holds float metres, not 16-bit units
layout(constant_id = 1) const bool kDistorted = false;  // the source has lens distortion
layout(std430, binding = 0) readonly buffer Source { uint words[]; };
layout(binding = 1, r32f) uniform writeonly image2D depth_m;
layout(push_constant) uniform Push { ConvertDepthParams params; };

uint code_at(uvec2 pixel) {
    const uint index = pixel.y * params.lens.extent.x + pixel.x;
    if (kMetres) return words[index];
    return bitfieldExtract(words[index >> 1u], int(index & 1u) * 16, 16);
}

// The bits of floats from 0 upwards order like integers, and negative numbers, infinity and NaN come after all of them:
// one comparison sorts out whatever is no reading.
float metres(uint code) {
    const float value = kMetres ? uintBitsToFloat(code) : float(code) * params.metres_per_unit;
    return code - 1u < params.max_code ? value : 0.0;
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, params.lens.extent))) return;
    uvec2 source = pixel;
    bool seen = true;
    if (kDistorted) {
        vec2 source_px;
        seen = find_source(params.lens, pixel, source_px);
        // Depth is not interpolated: between a near and a far surface there is nothing.
        source = uvec2(clamp(ivec2(floor(source_px + 0.5)), ivec2(0), ivec2(params.lens.extent) - 1));
    }
    imageStore(depth_m, ivec2(pixel), vec4(seen ? metres(code_at(source)) : 0.0));
}
