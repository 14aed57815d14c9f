#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
// Pooling over samples in 16-bit floats.
#define NETWORK_HALVES
#include "specular/pool_samples_main.glsl"
