#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/test/test_saxpy.h"

// One binding of each kind that Patina's passes have, and next to no work: what is left is the cost of a pass itself.
layout(local_size_x = 64) in;
layout(binding = 0) uniform Settings { SaxpyParams settings; };
layout(std430, binding = 1) readonly buffer X { float x[]; };
layout(std430, binding = 2) buffer Y { float y[]; };
layout(binding = 3, r32f) uniform readonly image2D source;
layout(binding = 4, r32f) uniform writeonly image2D target;
layout(push_constant) uniform Push { SaxpyParams params; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    y[i] += settings.a * params.a * x[i];
    imageStore(target, ivec2(i, 0), imageLoad(source, ivec2(i, 0)) + y[i]);
}
