#version 460
#extension GL_GOOGLE_include_directive : require
// Lists what is due of the records that this frame's observations changed; those whose lights were never marched in a
// list of their own.
#include "reflectance/due_main.glsl"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 8) readonly buffer ChangedList { uint changed_list[]; };
layout(std430, binding = 9) buffer NeverMarched { uint never_marched[]; };
layout(std430, binding = 10) buffer NeverMarchedArguments { uint never_marched_arguments[]; };

void list_for_marching(uint record, bool marched) {
    if (marched) {
        APPEND_RECORD(march, march_arguments, record)
    } else {
        APPEND_RECORD(never_marched, never_marched_arguments, record)
    }
}

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item < changed_list[0]) consider(changed_list[1u + item], true, false);
}
