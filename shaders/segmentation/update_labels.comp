#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Updating of labels with the map in storage buffers, as every device can bind them.
#include "shared/fusion/voxel_map.h"
layout(std430, binding = 8) readonly buffer Tsdf { uvec4 quads[]; }
tsdf[kMaxVoxelChunks];
#define QUAD(C, i) tsdf[C].quads[i]
#include "segmentation/update_labels_main.glsl"
