#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Vertices with the distances in texel buffers, which software devices gather faster than storage buffers.
#include "shared/extract_surface.h"
layout(std430, binding = 0) readonly buffer Neighbours { uint neighbours[]; };
layout(binding = 4, r32ui) uniform readonly uimageBuffer Tsdf[kMaxTsdfChunks];
#define NEIGHBOUR(i) neighbours[i]
#define VOXEL(C, i) imageLoad(Tsdf[C], int(i)).x
#include "surface/write_vertices_main.glsl"
