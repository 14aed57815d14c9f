// Activations in 16-bit floats, two in a word, and arithmetic in them. What goes into the first layer, and what comes
// out of the last, is in 32-bit floats (wide). Images and activations beyond kLargestHalf are taken for that; what the
// last layer gives may be infinite or NaN, which whoever takes it refuses. Needs shaderFloat16, but no 16-bit storage.
#define Quad f16vec4
#define Quads f16mat4
#include "specular/layer_common.glsl"

const float kLargestHalf = 65504.0;

layout(constant_id = 8) const uint kWideInputs = 0u;
layout(constant_id = 9) const uint kWideOutputs = 0u;

layout(std430, binding = 1) writeonly buffer Outputs { uvec2 outputs[]; };
layout(std430, binding = 2) readonly buffer Inputs { uvec2 inputs[]; };

f16vec4 unpacked(uvec2 words) { return f16vec4(unpackFloat2x16(words.x), unpackFloat2x16(words.y)); }

f16vec4 input_quad(uint i) {
    if (kWideInputs == 0u) return unpacked(inputs[i]);
    const vec4 wide = vec4(uintBitsToFloat(inputs[2u * i]), uintBitsToFloat(inputs[2u * i + 1u]));
    return f16vec4(clamp(wide, -kLargestHalf, kLargestHalf));
}

void store_quad(uint i, f16vec4 sum) {
    const f16vec4 quad = kWideOutputs == 0u ? clamp(sum, f16vec4(-kLargestHalf), f16vec4(kLargestHalf)) : sum;
    if (kWideOutputs == 0u) {
        outputs[i] = uvec2(packFloat2x16(quad.xy), packFloat2x16(quad.zw));
        return;
    }
    outputs[2u * i] = floatBitsToUint(vec2(quad.xy));
    outputs[2u * i + 1u] = floatBitsToUint(vec2(quad.zw));
}

#define INPUT(i) input_quad(i)
#define OUTPUT(i, quad) store_quad(i, quad)
