#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Refinement with the observations in storage buffers, as every device can bind them.
#include "shared/observation/observations.h"
layout(std430, binding = 7) readonly buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 12) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
#include "reflectance/refine_albedo_main.glsl"
