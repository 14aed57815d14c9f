#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
// Convolution in 16-bit floats.
#define NETWORK_HALVES
#include "specular/convolve_main.glsl"
