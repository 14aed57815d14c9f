// Counts the shining pixels of each group, so that they can be listed in the picture's order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/lighting/find_lights.h"

layout(local_size_x = kEmitterGroup) in;
layout(rgba16f, binding = 0) uniform readonly image2D color;
layout(std140, binding = 1) uniform Params { FindLightsParams params; };
layout(std430, binding = 2) writeonly buffer Counts { uint counts[]; };
#include "lib/lighting/emitters.glsl"

shared uint count;

void main() {
    if (gl_LocalInvocationIndex == 0u) count = 0u;
    barrier();
    ivec2 pixel;
    vec4 value;
    if (shines(gl_GlobalInvocationID.x, pixel, value)) atomicAdd(count, 1u);
    barrier();
    if (gl_LocalInvocationIndex == 0u) counts[gl_WorkGroupID.x] = count;
}
