#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define PATINA_WITH_COLOR 1
#include "fusion/integrate_main.glsl"
