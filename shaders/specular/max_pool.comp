#version 460
#extension GL_GOOGLE_include_directive : require
// Max pooling in 32-bit floats.
#include "specular/max_pool_main.glsl"
