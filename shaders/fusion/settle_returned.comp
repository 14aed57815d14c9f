#version 460
#extension GL_GOOGLE_include_directive : require
// After blocks came back: the dispatch over all block ids in use.
#include "shared/fusion/allocate_blocks.h"

layout(local_size_x = 1) in;
layout(std430, binding = 0) readonly buffer Counters { MapCounters counters; };
layout(std430, binding = 1) writeonly buffer BlockArguments { uvec4 block_arguments; };

void main() { block_arguments = uvec4((counters.high_water + kAssignGroup - 1u) / kAssignGroup, 1u, 1u, 0u); }
