#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the 26 blocks around every block, itself, and its key.
#include "shared/surface/extract_surface.h"
layout(local_size_x = kSurfaceGroup) in;
layout(std430, binding = 0) readonly buffer Keys { uvec4 keys[]; };
layout(std430, binding = 1) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 2) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 3) writeonly buffer Neighbours { uint neighbours[]; };
layout(push_constant) uniform Push { SurfaceParams params; };
#define KEYS(bucket) keys[bucket]
#define BLOCK(slot) blocks[slot]
#include "lib/map/block_lookup.glsl"

void main() {
    const uint item = group_item(gl_WorkGroupID) * kSurfaceGroup + gl_LocalInvocationIndex;
    const uint block = item / kNeighbourStride;
    const uint lane = item % kNeighbourStride;
    if (block >= params.items) return;
    const uint key = block < params.no_block ? block_keys[block] : kEmptyKey;
    uint found = kNoBlock;
    if (key != kEmptyKey && lane < kOwnKey) {
        const ivec3 offset = ivec3(lane % 3u, lane / 3u % 3u, lane / 9u) - 1;
        found = find_block(params.grid, block_of_key(params.grid, key) + offset);
    }
    neighbours[item] = lane == kOwnKey ? key : min(found, params.no_block);
}
