#version 460
#extension GL_GOOGLE_include_directive : require
// Lists what is due of the records that this frame's observations changed.
#include "reflectance/due_main.glsl"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 8) readonly buffer ChangedList { uint changed_list[]; };

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item < changed_list[0]) consider(changed_list[1u + item], true, false);
}
