// Weights in the format of layer_floats.glsl.
layout(std430, binding = 3) readonly buffer Weights { vec4 weights[]; };
#define WEIGHT(i) weights[i]
