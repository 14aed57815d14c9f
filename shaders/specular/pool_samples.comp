#version 460
#extension GL_GOOGLE_include_directive : require
// Pooling over samples in 32-bit floats.
#include "specular/pool_samples_main.glsl"
