// Body of the shaders that look up the map's labels at the surface points of an image. The includer declares the view's
// grid of blocks and the map's labels and how to load them:
//   CELL(i)         uint, the block id in a cell of the view grid
//   WORD(C, i)      uint, the label word of voxel i of the literal chunk C
#include "lib/view_grid.glsl"
#include "lib/voxel_chunks.glsl"
#include "lib/voxel_labels.glsl"

layout(constant_id = 1) const int kStride = 1;  // of the pixels in x and y
layout(local_size_x = kLabelGroupX, local_size_y = kLabelGroupY) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(std140, binding = 2) uniform View { ViewParams view; };
layout(binding = 3, r32ui) uniform readonly uimageBuffer Parents;
layout(binding = 5, r32ui) uniform writeonly uimage2D map_label;

uint label_at(vec3 point_m) {
    const ivec3 voxel = ivec3(floor(point_m / view.grid.voxel_m));
    const uint cell = view_grid_cell(view.grid_low.xyz, view.grid_size.xyz, voxel >> 3);
    const uint found = CELL(cell == kOutsideGrid ? 0u : cell);
    const bool have = cell != kOutsideGrid && found != kNoBlock;
    const uint block = have ? found : 0u;
    const ivec3 within = voxel & 7;
    const uint index =
        index_in_chunk(view.grid.chunk_shift, block) * kBlockVoxels + uint(within.z << 6 | within.y << 3 | within.x);
    uint word;
#define LOAD_WORD(C) word = WORD(C, index)
    WITH_CHUNK(view.grid.chunk_shift, block, LOAD_WORD)
    return have ? imageLoad(Parents, int(voxel_label(word))).x : kNoLabel;
}

void main() {
    const ivec2 sampled = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 pixel = sampled * kStride;
    if (any(greaterThanEqual(pixel, imageSize(position_m)))) return;
    const vec4 point = imageLoad(position_m, pixel);
    uint label = kNoLabel;
    if (point.w > 0.0) {
        label = label_at(point.xyz);
        if (label == kNoLabel) {
            const vec3 across = imageLoad(normal, pixel).xyz * (0.75 * view.grid.voxel_m);
            label = label_at(point.xyz - across);
            if (label == kNoLabel) label = label_at(point.xyz + across);
        }
    }
    imageStore(map_label, sampled, uvec4(label));
}
