// Weights in the format of layer_halves.glsl.
layout(std430, binding = 3) readonly buffer Weights { uvec2 weights[]; };
#define WEIGHT(i) unpacked(weights[i])
