// As layer.glsl, for layers that have weights.
#ifndef PATINA_SPECULAR_WEIGHTED_LAYER_GLSL
#define PATINA_SPECULAR_WEIGHTED_LAYER_GLSL
#include "specular/layer.glsl"

#ifdef NETWORK_TEXELS
layout(rgba32f, binding = 3) uniform readonly imageBuffer Weights;
#define WEIGHT(i) imageLoad(Weights, int(i))
#else
layout(std430, binding = 3) readonly buffer Weights { vec4 weights[]; };
#define WEIGHT(i) weights[i]
#endif

vec4 activated(vec4 sum) { return params.relu != 0u ? max(sum, 0.0) : sum; }

#endif
