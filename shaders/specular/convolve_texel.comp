#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Convolution in 32-bit floats, through texel buffers.
#define NETWORK_TEXELS
#include "specular/convolve_main.glsl"
