#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Vertices with the distances and neighbours in texel buffers, which software devices gather faster than storage
// buffers.
#include "shared/surface/extract_surface.h"
layout(binding = 0, r32ui) uniform readonly uimageBuffer Neighbours;
layout(binding = 4, r32ui) uniform readonly uimageBuffer Tsdf[kMaxVoxelChunks];
#define NEIGHBOUR(i) imageLoad(Neighbours, int(i)).x
#define VOXEL(C, i) imageLoad(Tsdf[C], int(i)).x
#include "surface/write_vertices_main.glsl"
