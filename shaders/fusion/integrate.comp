#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define PATINA_MARK_SURFACE 0
#include "fusion/integrate_main.glsl"
