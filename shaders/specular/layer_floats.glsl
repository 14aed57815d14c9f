// Activations in 32-bit floats, in storage buffers, as every device can bind them.
#define Quad vec4
#define Quads mat4
#include "specular/layer_common.glsl"

layout(std430, binding = 1) writeonly buffer Outputs { vec4 outputs[]; };
layout(std430, binding = 2) readonly buffer Inputs { vec4 inputs[]; };
#define INPUT(i) inputs[i]
#define OUTPUT(i, quad) outputs[i] = quad
