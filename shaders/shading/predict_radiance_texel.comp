#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Predicts with the view's records in texel buffers, which software devices gather faster than storage buffers.
layout(binding = 4, r32ui) uniform readonly uimageBuffer ViewGrid;
layout(binding = 5, r32ui) uniform readonly uimageBuffer Entries;
layout(binding = 6, rgba32ui) uniform readonly uimageBuffer Packed;
#define CELL(i) imageLoad(ViewGrid, int(i)).x
#define ENTRY(i) imageLoad(Entries, int(i)).x
#define PACKED(i) imageLoad(Packed, int(i))
#include "shading/predict_radiance_main.glsl"
