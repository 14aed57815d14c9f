#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
// Fully connected layer in 16-bit floats, with sums in 32 bits.
#define NETWORK_HALVES
#include "specular/connect_main.glsl"
