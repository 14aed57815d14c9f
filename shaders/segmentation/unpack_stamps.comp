#version 460
#extension GL_GOOGLE_include_directive : require
// When the labels of blocks that came back were updated last.
#include "shared/fusion/stream_blocks.h"

layout(local_size_x = kLeaveGroup) in;
layout(std430, binding = 0) readonly buffer Streamed { StreamedBlock streamed[]; };
layout(std430, binding = 1) buffer Stamps { uint stamps[]; };
layout(push_constant) uniform Push { StreamParams params; };

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item < params.count && streamed[item].block != kNoBlock)
        stamps[streamed[item].block] = streamed[item].label_stamp;
}
