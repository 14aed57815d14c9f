// Weights in the format of layer_texels.glsl.
layout(rgba32f, binding = 3) uniform readonly imageBuffer Weights;
#define WEIGHT(i) imageLoad(Weights, int(i))
