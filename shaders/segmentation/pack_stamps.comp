#version 460
#extension GL_GOOGLE_include_directive : require
// Notes when the labels of blocks that leave were updated last.
#include "shared/fusion/stream_blocks.h"

layout(local_size_x = kLeaveGroup) in;
layout(std430, binding = 0) readonly buffer Stamps { uint stamps[]; };
layout(std430, binding = 1) buffer Streamed { StreamedBlock streamed[]; };
layout(std430, binding = 2) readonly buffer StreamedCount { uvec4 streamed_count; };  // x

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item < streamed_count.x) streamed[item].label_stamp = stamps[streamed[item].block];
}
