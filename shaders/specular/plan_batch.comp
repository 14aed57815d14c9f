#version 460
#extension GL_GOOGLE_include_directive : require
// Turns the number of segments in a batch into the group counts of dispatches over them.
#include "shared/specular/segment_batch.h"

layout(local_size_x = kBatchGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 1) readonly buffer Work { BatchWork work[]; };
layout(std430, binding = 2) writeonly buffer Arguments { uvec4 group_counts[]; };
layout(push_constant) uniform Push { BatchParams params; };

uint divided_up(uint a, uint b) { return (a + b - 1u) / b; }

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.passes) return;
    const uint images = min(batch[0], params.capacity) * work[i].images;
    const uint items = divided_up(images, work[i].images_per_tile) * work[i].items_per_tile;
    group_counts[i] = uvec4(divided_up(items, kBatchGroup), work[i].rows, 1u, 0u);
}
