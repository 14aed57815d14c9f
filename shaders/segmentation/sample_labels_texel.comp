#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Sampling of labels with the map in texel buffers, which software devices gather faster than storage buffers.
#include "shared/fusion/voxel_map.h"
layout(binding = 4, r32ui) uniform readonly uimageBuffer ViewGrid;
layout(binding = 6, r32ui) uniform readonly uimageBuffer Words[kMaxVoxelChunks];
#define CELL(i) imageLoad(ViewGrid, int(i)).x
#define WORD(C, i) imageLoad(Words[C], int(i)).x
#include "segmentation/sample_labels_main.glsl"
