#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Ray casting with the map in storage buffers, as every device can bind them.
#include "shared/fusion/voxel_map.h"
layout(std430, binding = 4) readonly buffer ViewGrid { uint view_grid[]; };
layout(std430, binding = 5) readonly buffer Tsdf { uint voxels[]; }
tsdf[kMaxVoxelChunks];
#define CELL(i) view_grid[i]
#define VOXEL(C, i) tsdf[C].voxels[i]
#include "fusion/raycast_main.glsl"
