#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Marches with the map in texel buffers, which software devices read faster than storage buffers.
#include "shared/fusion/voxel_map.h"
layout(binding = 4, rgba32ui) uniform readonly uimageBuffer Keys;
layout(binding = 5, r32ui) uniform readonly uimageBuffer Blocks;
layout(binding = 6, r32ui) uniform readonly uimageBuffer Tsdf[kMaxVoxelChunks];
layout(binding = 11, r32ui) uniform readonly uimageBuffer Color[kMaxVoxelChunks];
#define KEYS(bucket) imageLoad(Keys, int(bucket))
#define BLOCK(slot) imageLoad(Blocks, int(slot)).x
#define VOXEL(C, i) imageLoad(Tsdf[C], int(i)).x
#define COLOR(C, i) imageLoad(Color[C], int(i)).x
#include "shading/reflect_surroundings_main.glsl"
