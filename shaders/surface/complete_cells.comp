#version 460
#extension GL_GOOGLE_include_directive : require
// Marks the cells whose eight corners have all been seen. A cell belongs to the voxel at its lowest corner.
#include "shared/surface/extract_surface.h"
layout(local_size_x = kSurfaceGroup) in;
layout(std430, binding = 0) readonly buffer Neighbours { uint neighbours[]; };
layout(std430, binding = 1) readonly buffer Seen { uint seen[]; };
layout(std430, binding = 2) writeonly buffer Complete { uint complete[]; };
layout(push_constant) uniform Push { SurfaceParams params; };
#define NEIGHBOUR(i) neighbours[i]
#define SEEN(i) seen[i]
#include "lib/map/surface_words.glsl"
#include "lib/map/voxel_map.glsl"

void main() {
    const uint item = group_item(gl_WorkGroupID) * kSurfaceGroup + gl_LocalInvocationIndex;
    const uint block = item / kBlockWords;
    const uint word = item % kBlockWords;
    if (block >= params.items) return;
    complete[item] = all_of(CORNERS_AT(SEEN, block, word, 0) & CORNERS_AT(SEEN, block, word, 1));
}
