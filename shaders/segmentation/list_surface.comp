#version 460
#extension GL_GOOGLE_include_directive : require
// Lists those of the blocks which a frame's surface points lie in that have their turn, or never had it.
#include "lib/view_grid.glsl"
#include "lib/voxel_map.glsl"
#include "shared/segments.h"

layout(local_size_x = kLabelGroupX, local_size_y = kLabelGroupY) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(std140, binding = 1) uniform View { ViewParams view; };
layout(std430, binding = 2) readonly buffer ViewGrid { uint view_grid[]; };
layout(std430, binding = 3) buffer Stamps { uint stamps[]; };  // per block: of the frame that listed it last; 0: never
layout(std430, binding = 4) buffer Surface { uint surface[]; };
layout(std430, binding = 5) buffer Arguments { uint arguments[]; };
layout(push_constant) uniform Push { ListSurfaceParams params; };

void list_block(uint block) {
    if (stamps[block] >= params.stamp || atomicMax(stamps[block], params.stamp) >= params.stamp) return;
    const uint item = atomicAdd(surface[0], 1u);
    surface[1u + item] = block;
    atomicMax(arguments[0], min(item + 1u, kGroupsPerRow));
    if (item % kGroupsPerRow == 0u) atomicMax(arguments[1], item / kGroupsPerRow + 1u);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy * kListStride) + int(params.stamp % kListStride);
    // Outside the image there is no surface: images read zero there.
    const vec4 point = imageLoad(position_m, pixel);
    if (point.w <= 0.0) return;
    const ivec3 coordinates = ivec3(floor(point.xyz / view.grid.voxel_m)) >> 3;
    const uint cell = view_grid_cell(view.grid_low.xyz, view.grid_size.xyz, coordinates);
    if (cell == kOutsideGrid) return;
    const uint block = view_grid[cell];
    if (block == kNoBlock) return;
    const uint turn = hash_of_key(key_of_block(view.grid, coordinates)) % kUpdateFrames;
    if (turn == params.stamp % kUpdateFrames || stamps[block] == 0u) list_block(block);
}
