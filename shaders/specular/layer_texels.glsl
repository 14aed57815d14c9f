// Activations in 32-bit floats, read through texel buffers, which software devices gather faster than storage buffers.
#define Quad vec4
#define Quads mat4
#include "specular/layer_common.glsl"

layout(std430, binding = 1) writeonly buffer Outputs { vec4 outputs[]; };
layout(rgba32f, binding = 2) uniform readonly imageBuffer Inputs;
#define INPUT(i) imageLoad(Inputs, int(i))
#define OUTPUT(i, quad) outputs[i] = quad
