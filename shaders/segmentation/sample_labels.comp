#version 460
#extension GL_GOOGLE_include_directive : require
// Looks up the map's labels at the surface points of an image.
#include "lib/voxel_chunks.glsl"
#include "lib/voxel_labels.glsl"
#include "shared/visible_blocks.h"

layout(local_size_x = kLabelGroupX, local_size_y = kLabelGroupY) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(std140, binding = 2) uniform View { ViewParams view; };
layout(std430, binding = 3) readonly buffer ViewGrid { uint view_grid[]; };
layout(binding = 4, r32ui) uniform readonly uimageBuffer Parents;
layout(binding = 5, r32ui) uniform writeonly uimage2D map_label;
layout(std430, binding = 6) readonly buffer Words { uint items[]; }
words[kMaxVoxelChunks];
#define CELL(i) view_grid[i]
#include "lib/surface_voxel.glsl"

uint label_at(vec3 point_m) {
    const uint voxel = surface_voxel(point_m);
    if (voxel == kNoVoxel) return kNoLabel;
    const uint block = voxel / kBlockVoxels;
    const uint index = index_in_chunk(view.grid.chunk_shift, block) * kBlockVoxels + voxel % kBlockVoxels;
    uint word;
#define LOAD_WORD(C) word = words[C].items[index]
    WITH_CHUNK(view.grid.chunk_shift, block, LOAD_WORD)
    return imageLoad(Parents, int(voxel_label(word))).x;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(position_m)))) return;
    const vec4 point = imageLoad(position_m, pixel);
    uint label = kNoLabel;
    if (point.w > 0.0) {
        // A voxel that the surface crosses at a corner may have been seen by no pixel yet.
        const vec3 across = imageLoad(normal, pixel).xyz * (0.5 * view.grid.voxel_m);
        label = label_at(point.xyz);
        if (label == kNoLabel) label = label_at(point.xyz - across);
        if (label == kNoLabel) label = label_at(point.xyz + across);
    }
    imageStore(map_label, pixel, uvec4(label));
}
