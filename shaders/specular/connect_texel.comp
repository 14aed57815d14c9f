#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Fully connected layer with activations and weights in texel buffers, which software devices gather faster than
// storage buffers.
#define NETWORK_TEXELS
#include "specular/connect_main.glsl"
