#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Marches with the map in texel buffers, which software devices gather faster than storage buffers.
#include "shared/fusion/voxel_map.h"
layout(binding = 7, rgba32ui) uniform readonly uimageBuffer Keys;
layout(binding = 8, r32ui) uniform readonly uimageBuffer Blocks;
layout(binding = 9, r32ui) uniform readonly uimageBuffer Tsdf[kMaxVoxelChunks];
#define KEYS(bucket) imageLoad(Keys, int(bucket))
#define BLOCK(slot) imageLoad(Blocks, int(slot)).x
#define VOXEL(C, i) imageLoad(Tsdf[C], int(i)).x
#include "reflectance/find_visibility_main.glsl"
