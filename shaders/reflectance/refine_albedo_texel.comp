#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Refinement with the observations in texel buffers, which software devices gather faster than storage buffers.
#include "shared/observation/observations.h"
layout(binding = 7, rgba32ui) uniform readonly uimageBuffer Directions[kMaxVoxelChunks];
layout(binding = 12, rgba32ui) uniform readonly uimageBuffer Colors[kMaxVoxelChunks];
#define DIRECTION_QUAD(C, i) imageLoad(Directions[C], int(i))
#define COLOR_QUAD(C, i) imageLoad(Colors[C], int(i))
#include "reflectance/refine_albedo_main.glsl"
