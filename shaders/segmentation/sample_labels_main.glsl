// Body of the shaders that look up the map's labels at the surface points of an image, and list the blocks that these
// lie in. The includer declares the view's grid of blocks and the map's labels and how to load them:
//   CELL(i)         uint, the block id in a cell of the view grid
//   LABEL(C, i)     uint, the label word of voxel i of the literal chunk C
#include "lib/view_grid.glsl"
#include "lib/voxel_chunks.glsl"
#include "lib/voxel_labels.glsl"

layout(local_size_x = kLabelGroupX, local_size_y = kLabelGroupY) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(std140, binding = 1) uniform View { ViewParams view; };
layout(binding = 2, r32ui) uniform readonly uimageBuffer Parents;
layout(binding = 3, r32ui) uniform writeonly uimage2D map_label;
layout(std430, binding = 10) buffer Marks { uint marks[]; };  // per block: 1 once it is listed
layout(std430, binding = 11) buffer Surface { uint surface[]; };
layout(std430, binding = 12) buffer Arguments { uint arguments[]; };

void list_block(uint block) {
    if (marks[block] != 0u || atomicExchange(marks[block], 1u) != 0u) return;
    const uint item = atomicAdd(surface[0], 1u);
    surface[1u + item] = block;
    atomicMax(arguments[0], min(item + 1u, kGroupsPerRow));
    if (item % kGroupsPerRow == 0u) atomicMax(arguments[1], item / kGroupsPerRow + 1u);
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(position_m)))) return;
    const vec4 point = imageLoad(position_m, pixel);
    const ivec3 voxel = ivec3(floor(point.xyz / view.grid.voxel_m));
    const uint cell = view_grid_cell(view.grid_low.xyz, view.grid_size.xyz, voxel >> 3);
    const bool inside = point.w > 0.0 && cell != kOutsideGrid;
    const uint found = CELL(inside ? cell : 0u);
    const bool have = inside && found != kNoBlock;
    const uint block = have ? found : 0u;
    const ivec3 within = voxel & 7;
    const uint index =
        index_in_chunk(view.grid.chunk_shift, block) * kBlockVoxels + uint(within.z << 6 | within.y << 3 | within.x);
    uint word;
#define LOAD_LABEL(C) word = LABEL(C, index)
    WITH_CHUNK(view.grid.chunk_shift, block, LOAD_LABEL)
    const uint root = imageLoad(Parents, int(voxel_label(word))).x;
    imageStore(map_label, pixel, uvec4(have ? root : kNoLabel));
    if (have) list_block(block);
}
