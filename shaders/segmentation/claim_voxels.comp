#version 460
#extension GL_GOOGLE_include_directive : require
// Looks up the map's labels at the surface points of a frame, and settles which pixel speaks for a voxel that several
// of them see: the one with the largest tag.
#include "lib/camera.glsl"
#include "lib/voxel_chunks.glsl"
#include "lib/voxel_labels.glsl"
#include "shared/visible_blocks.h"

layout(local_size_x = kLabelGroupX, local_size_y = kLabelGroupY) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform readonly image2D normal;
layout(std140, binding = 2) uniform View { ViewParams view; };
layout(binding = 3, r32ui) uniform readonly uimageBuffer Parents;
layout(binding = 4, r32ui) uniform writeonly uimage2D map_label;
layout(binding = 5, r32ui) uniform writeonly uimage2D voxel;
layout(std430, binding = 6) coherent buffer Words { uint items[]; }
words[kMaxVoxelChunks];
layout(std430, binding = 11) readonly buffer ViewGrid { uint view_grid[]; };
#define CELL(i) view_grid[i]
#include "lib/surface_voxel.glsl"

const float kGrazingCosine = 0.2;  // of steeper views the pixels say little

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(position_m)))) return;
    const vec4 point = imageLoad(position_m, pixel);
    uint found = point.w > 0.0 ? surface_voxel(point.xyz) : kNoVoxel;
    uint label = kNoLabel;
    if (found != kNoVoxel) {
        const uint block = found / kBlockVoxels;
        const uint index = index_in_chunk(view.grid.chunk_shift, block) * kBlockVoxels + found % kBlockVoxels;
        uint word;
#define LOAD_WORD(C) word = words[C].items[index]
        WITH_CHUNK(view.grid.chunk_shift, block, LOAD_WORD)
        label = imageLoad(Parents, int(voxel_label(word))).x;
        // Pixels that see one voxel from so near that it covers more of them than tags can tell apart do not speak.
        const float edge_px = view.grid.voxel_m * view.camera.focal_center_px.x / point.w;
        const vec3 toward = camera_center_m(view.camera) - point.xyz;
        const bool grazing = dot(imageLoad(normal, pixel).xyz, toward) < kGrazingCosine * length(toward);
        if (grazing || edge_px > kMostVoxelPixels) {
            found = kNoVoxel;
        } else {
            const uint claim = tagged(word, pixel_tag(uvec2(pixel)));
#define CLAIM_WORD(C) atomicMax(words[C].items[index], claim)
            WITH_CHUNK(view.grid.chunk_shift, block, CLAIM_WORD)
        }
    }
    imageStore(map_label, pixel, uvec4(label));
    imageStore(voxel, pixel, uvec4(found));
}
