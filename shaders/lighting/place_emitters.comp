// Where each group's emitters begin in the list: the sums of the counts before it, and the sum of all at the end.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/lighting/find_lights.h"

layout(local_size_x = kEmitterGroup) in;
layout(std140, binding = 0) uniform Params { FindLightsParams params; };
layout(std430, binding = 1) readonly buffer Counts { uint counts[]; };
layout(std430, binding = 2) writeonly buffer Places { uint places[]; };

shared uint sums[kEmitterGroup];

void main() {
    const uint lane = gl_LocalInvocationIndex;
    const uint each = (params.group_count + kEmitterGroup - 1u) / kEmitterGroup;
    const uint first = min(lane * each, params.group_count), last = min(first + each, params.group_count);
    uint own = 0u;
    for (uint i = first; i < last; ++i) own += counts[i];
    sums[lane] = own;
    barrier();
    for (uint reach = 1u; reach < kEmitterGroup; reach *= 2u) {
        const uint before = lane >= reach ? sums[lane - reach] : 0u;
        barrier();
        sums[lane] += before;
        barrier();
    }
    uint place = sums[lane] - own;
    for (uint i = first; i < last; ++i) {
        places[i] = place;
        place += counts[i];
    }
    if (lane == kEmitterGroup - 1u) places[params.group_count] = sums[lane];
}
