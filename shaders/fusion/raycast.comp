#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Ray casting with the map in storage buffers, as every device can bind them.
#include "shared/voxel_map.h"
layout(std430, binding = 4) readonly buffer Keys { uvec4 keys[]; };
layout(std430, binding = 5) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 6) readonly buffer Tsdf { uint voxels[]; } tsdf[kMaxVoxelChunks];
#define KEYS(bucket) keys[bucket]
#define BLOCK(slot) blocks[slot]
#define VOXEL(C, i) tsdf[C].voxels[i]
#include "fusion/raycast_main.glsl"
