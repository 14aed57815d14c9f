#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Sampling of labels with the map in storage buffers, as every device can bind them.
#include "shared/fusion/voxel_map.h"
layout(std430, binding = 4) readonly buffer ViewGrid { uint view_grid[]; };
layout(std430, binding = 6) readonly buffer Words { uint items[]; }
words[kMaxVoxelChunks];
#define CELL(i) view_grid[i]
#define WORD(C, i) words[C].items[i]
#include "segmentation/sample_labels_main.glsl"
