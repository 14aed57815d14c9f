#version 460
#extension GL_GOOGLE_include_directive : require
// Perceptual parameters of materials, and the materials that they mean.
#include "lib/color/perceptual.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Materials { WardMaterial materials[]; };
layout(std430, binding = 1) writeonly buffer Perceptual { PerceptualMaterial perceptual[]; };
layout(std430, binding = 2) writeonly buffer Returned { WardMaterial returned[]; };
layout(push_constant) uniform Push { PerceptualParams params; };

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    perceptual[i] = perceptual_of(materials[i]);
    returned[i] = material_of(perceptual_of(materials[i]));
}
