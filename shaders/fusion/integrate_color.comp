#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The mean of the colours that voxels near the surface have been seen in, a sliding one where their weight is at its
// cap: over that many of their block's turns. One workgroup per block that integration listed. Its quads near the
// surface are listed first, about a third of all, and the invocations share these: software devices run through every
// branch, whether or not a voxel takes it.
#include "lib/camera/camera.glsl"
#include "lib/camera/pixel_row.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_map.glsl"
#include "shared/fusion/allocate_blocks.h"
#include "shared/fusion/integrate.h"

layout(local_size_x = kIntegrateGroup) in;
layout(std430, binding = 0) readonly buffer Visible { uint visible[]; };
layout(std430, binding = 1) readonly buffer BlockKeys { uint block_keys[]; };
layout(std140, binding = 2) uniform Fusion { FusionParams fusion; };
layout(std430, binding = 3) readonly buffer NearSurface { uint near_surface[]; };
layout(std430, binding = 4) readonly buffer ColorBlocks { uint color_blocks[]; };
layout(binding = 5, rgba16f) uniform readonly image2D color_linear;
layout(std430, binding = 6) readonly buffer Tsdf { uvec4 quads[]; }
tsdf[kMaxVoxelChunks];
layout(std430, binding = 7) buffer Color { uvec4 quads[]; }
color[kMaxVoxelChunks];

shared uint listed_quads;
shared uint list[kBlockVoxels / 4u];  // quad | which of its voxels take colour << 8

// The mean of what a voxel's colour was and what the colour camera sees at its place, by the weight of its distance.
uint update_color(uint color, uint voxel, vec2 pixel, uint dither) {
    const vec4 seen = imageLoad(color_linear, ivec2(floor(pixel + 0.5)));
    const float weight = min(float(voxel_weight(voxel)), fusion.max_color_weight);
    const float share = color == 0u ? 1.0 : min(float(kWeightOne) / weight, 1.0);
    return seen.a > 0.0 ? pack_color(mix(voxel_color(color), seen.rgb, share), dither) : color;
}

// Four voxels along x, from `voxel` on: quad `quad` of the block's chunk. Bit i of `near`: voxel i takes colour.
void integrate_quad(uint block, uint quad, ivec3 voxel, uint near, uint dither) {
    const vec3 world_m = (vec3(voxel) + 0.5) * fusion.grid.voxel_m;
    const PixelRow row = pixel_row(fusion.color_camera, world_m, fusion.grid.voxel_m);
#define LOAD_TSDF(C) voxels = tsdf[C].quads[quad]
#define LOAD_COLOR(C) colors = color[C].quads[quad]
#define STORE_COLOR(C) color[C].quads[quad] = colors
    uvec4 voxels, colors;
    WITH_CHUNK(fusion.grid.chunk_shift, block, LOAD_TSDF)
    WITH_CHUNK(fusion.grid.chunk_shift, block, LOAD_COLOR)
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const uint updated = update_color(colors[i], voxels[i], pixel_of(row, i), hash_of_key(dither + uint(i)));
        colors[i] = (near >> i & 1u) != 0u ? updated : colors[i];
    }
    WITH_CHUNK(fusion.grid.chunk_shift, block, STORE_COLOR)
}

void main() {
    const uint listed = group_item(gl_WorkGroupID);
    if (listed >= color_blocks[0]) return;
    const uint item = color_blocks[1u + listed];
    const uint block = visible[1u + item];
    const uint key = block_keys[block];
    const ivec3 corner = block_of_key(fusion.grid, key) * int(kBlockEdge);
    const uint first_quad = index_in_chunk(fusion.grid.chunk_shift, block) * (kBlockVoxels / 4u);
    const uint dither = hash_of_key(key ^ fusion.frame_index * 0x9e3779b9u ^ fusion.seed);
    if (gl_LocalInvocationIndex == 0u) listed_quads = 0u;
    barrier();
    const uint near = near_surface[item * kIntegrateGroup + gl_LocalInvocationIndex];
    [[unroll]] for (uint i = 0u; i < kQuadsPerInvocation; ++i) {
        const uint quad_near = near >> 4u * i & 15u;
        const uint quad = i * kIntegrateGroup + gl_LocalInvocationIndex;
        if (quad_near != 0u) list[atomicAdd(listed_quads, 1u)] = quad | quad_near << 8;
    }
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < listed_quads; i += kIntegrateGroup) {
        const uint quad = list[i] & 0xffu;
        const ivec3 within = ivec3((quad & 1u) * 4u, quad >> 1 & 7u, quad >> 4);
        integrate_quad(block, first_quad + quad, corner + within, list[i] >> 8, dither + quad * 4u);
    }
}
