#version 460
#extension GL_GOOGLE_include_directive : require
// Decides which blocks leave: those in the first bins, as many whole bins as fit. It does not matter in which order
// invocations found them.
#include "shared/fusion/stream_blocks.h"

layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Leaving { uint leaving[]; };
layout(push_constant) uniform Push { LeaveParams params; };

void main() {
    uint bins = 0u;
    for (uint chosen = 0u; bins < kAcceptBins; ++bins) {
        chosen += leaving[kLeavingBins + bins];
        if (chosen > params.most) break;
    }
    leaving[kLeavingAccepted] = bins;
}
