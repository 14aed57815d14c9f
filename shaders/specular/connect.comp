#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Fully connected layer with activations and weights in storage buffers, as every device can bind them.
#include "specular/connect_main.glsl"
