#version 460
#extension GL_GOOGLE_include_directive : require
// Lists those of the visible blocks that have their turn, or never had it. A surface that comes into view bit by bit,
// as the narrow side of a thing, does so in blocks that have had their first turn: they have others soon, as those have
// whose labels change.
#include "lib/map/voxel_map.glsl"
#include "shared/segmentation/segments.h"

layout(local_size_x = kSweepGroup) in;
layout(std430, binding = 0) readonly buffer Visible { uint visible[]; };  // count, then block ids
layout(std430, binding = 1) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 2) buffer Stamps { uint stamps[]; };  // as LabelMapIds::stamps
layout(std430, binding = 3) buffer Due { uint due[]; };        // count, then block ids | kSettledBlock
layout(std430, binding = 4) buffer Arguments { uint arguments[]; };
layout(push_constant) uniform Push { ListDueBlocksParams params; };

void main() {
    if (gl_GlobalInvocationID.x >= visible[0]) return;
    const uint block = visible[1u + gl_GlobalInvocationID.x];
    const uint known = stamps[block];
    const uint frames = (known & kSettledBlock) != 0u    ? kSettledFrames
                        : (known & kRestlessBlock) != 0u ? kRestlessFrames
                                                         : kUpdateFrames;
    if (known != 0u && hash_of_key(block_keys[block]) % frames != params.stamp % frames) return;
    stamps[block] = params.stamp;
    const uint item = atomicAdd(due[0], 1u);
    due[1u + item] = block | (known & kSettledBlock);
    if (item % kUpdateBlocks == 0u) GROW_ARGUMENTS(arguments, item / kUpdateBlocks)
}
