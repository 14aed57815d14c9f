#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Signs of the distances in texel buffers, which software devices gather faster than storage buffers.
#include "shared/fusion/voxel_map.h"
layout(binding = 3, rgba32ui) uniform readonly uimageBuffer Tsdf[kMaxVoxelChunks];
#define QUAD(C, i) imageLoad(Tsdf[C], int(i))
#include "surface/pack_signs_main.glsl"
