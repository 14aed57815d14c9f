#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/test/test_saxpy.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kRepeat = 1u;
layout(std430, binding = 0) readonly buffer X { float x[]; };
layout(std430, binding = 1) buffer Y { float y[]; };
layout(push_constant) uniform Push { SaxpyParams params; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    for (uint k = 0u; k < kRepeat; ++k) y[i] = params.a * x[i] + y[i];
}
