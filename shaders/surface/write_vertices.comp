#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Vertices with the distances in storage buffers, as every device can bind them.
#include "shared/surface/extract_surface.h"
layout(std430, binding = 0) readonly buffer Neighbours { uint neighbours[]; };
layout(std430, binding = 4) readonly buffer Tsdf { uint voxels[]; }
tsdf[kMaxVoxelChunks];
#define NEIGHBOUR(i) neighbours[i]
#define VOXEL(C, i) tsdf[C].voxels[i]
#include "surface/write_vertices_main.glsl"
