#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Marches with the map in storage buffers, as every device can bind them.
#include "shared/fusion/voxel_map.h"
layout(std430, binding = 4) readonly buffer Keys { uvec4 buckets[]; };
layout(std430, binding = 5) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 6) readonly buffer Tsdf { uint voxels[]; }
tsdf[kMaxVoxelChunks];
layout(std430, binding = 11) readonly buffer Color { uint voxels[]; }
color_of[kMaxVoxelChunks];
#define KEYS(bucket) buckets[bucket]
#define BLOCK(slot) blocks[slot]
#define VOXEL(C, i) tsdf[C].voxels[i]
#define COLOR(C, i) color_of[C].voxels[i]
#include "shading/reflect_surroundings_main.glsl"
