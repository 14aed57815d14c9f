#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Ray casting with the map in texel buffers, which software devices gather faster than storage buffers.
#include "shared/fusion/voxel_map.h"
layout(binding = 4, r32ui) uniform readonly uimageBuffer ViewGrid;
layout(binding = 5, r32ui) uniform readonly uimageBuffer Tsdf[kMaxVoxelChunks];
#define CELL(i) imageLoad(ViewGrid, int(i)).x
#define VOXEL(C, i) imageLoad(Tsdf[C], int(i)).x
#include "fusion/raycast_main.glsl"
