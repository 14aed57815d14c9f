#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The trilinear mean of the voxel colours around each surface point, over the voxels that have one.
#include "shared/fusion/shade_color.h"
#include "shared/fusion/visible_blocks.h"
layout(local_size_x = kShadeColorGroup, local_size_y = kShadeColorGroup) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform writeonly image2D color_linear;
layout(std140, binding = 2) uniform View { ViewParams view; };
layout(std430, binding = 3) readonly buffer ViewGrid { uint view_grid[]; };
layout(std430, binding = 4) readonly buffer Color { uint voxels[]; }
color[kMaxVoxelChunks];
#include "lib/camera/view_grid.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"

uint load_color(ivec3 coordinates) {
    const uint cell = view_grid_cell(view.grid_low.xyz, view.grid_size.xyz, coordinates >> 3);
    const uint block = cell == kOutsideGrid ? kNoBlock : view_grid[cell];
    if (block == kNoBlock) return 0u;
    const ivec3 within = coordinates & 7;
    const uint index =
        index_in_chunk(view.grid.chunk_shift, block) * kBlockVoxels + uint(within.z << 6 | within.y << 3 | within.x);
    uint packed;
#define LOAD_COLOR(C) packed = color[C].voxels[index]
    WITH_CHUNK(view.grid.chunk_shift, block, LOAD_COLOR)
    return packed;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(position_m)))) return;
    const vec4 point = imageLoad(position_m, pixel);
    vec4 sum = vec4(0.0);
    if (point.w > 0.0) {
        const vec3 at_vox = point.xyz / view.grid.voxel_m - 0.5;
        const ivec3 low = ivec3(floor(at_vox));
        const vec3 t = at_vox - vec3(low);
        for (int i = 0; i < 8; ++i) {
            const ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
            const uint packed = load_color(low + corner);
            const vec3 share = mix(1.0 - t, t, vec3(corner));
            const float weight = packed != 0u ? share.x * share.y * share.z : 0.0;
            sum += vec4(voxel_color(packed), 1.0) * weight;
        }
    }
    imageStore(color_linear, pixel, sum.w > 0.0 ? vec4(sum.rgb / sum.w, 1.0) : vec4(0.0));
}
