#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Predicts with the view's records in storage buffers, as every device can bind them.
layout(std430, binding = 4) readonly buffer ViewGrid { uint view_grid[]; };
layout(std430, binding = 5) readonly buffer Entries { uint entries[]; };
layout(std430, binding = 6) readonly buffer Packed { uvec4 packed_records[]; };
#define CELL(i) view_grid[i]
#define ENTRY(i) entries[i]
#define PACKED(i) packed_records[i]
#include "shading/predict_radiance_main.glsl"
