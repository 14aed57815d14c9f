// Body of the shaders that look up the map's labels at the surface points of an image. A group lists the points whose
// voxel has none before it looks behind and before them: software devices run a branch whether an invocation takes it
// or not, and a loop's body at least once in all vectors of a group. The includer declares the view's grid of blocks
// and the map's labels and how to load them:
//   CELL(i)         uint, the block id in a cell of the view grid
//   WORD(C, i)      uint, the label word of voxel i of the literal chunk C
#include "lib/camera/view_grid.glsl"
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_labels.glsl"

layout(constant_id = 1) const int kStride = 1;  // of the pixels in x and y
layout(local_size_x = kAskGroup) in;
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

shared uint listed;
shared uint list[kAskGroup * kAskRows];  // x and y << 16 of points whose voxel has no label, in any order

// An invocation goes down a column of the group's tile.
void label_points(ivec2 corner) {
    const ivec2 full = imageSize(position_m);
    const int x = corner.x + int(gl_LocalInvocationIndex);
    uint unknown = 0u;
    [[dont_unroll]] for (int i = 0; i < int(kAskRows); ++i) {
        const ivec2 sampled = ivec2(x, corner.y + i);
        const vec4 point = imageLoad(position_m, sampled * kStride);  // beyond the image zero
        const uint label = point.w > 0.0 ? label_at(point.xyz) : kNoLabel;
        const bool is_unknown = point.w > 0.0 && label == kNoLabel;
        unknown |= uint(is_unknown) << i;
        if (!is_unknown && all(lessThan(sampled * kStride, full))) imageStore(map_label, sampled, uvec4(label));
    }
    uint place = unknown == 0u ? 0u : atomicAdd(listed, uint(bitCount(unknown)));
    for (uint bits = unknown; bits != 0u; bits &= bits - 1u) {
        list[place++] = uint(x) | uint(corner.y + findLSB(bits)) << 16;
    }
}

void main() {
    if (gl_LocalInvocationIndex == 0u) listed = 0u;
    barrier();
    label_points(ivec2(gl_WorkGroupID.xy * uvec2(kAskGroup, kAskRows)));
    barrier();
    const uint count = listed;
    for (uint i = gl_LocalInvocationIndex; i < count; i += kAskGroup) {
        const ivec2 sampled = ivec2(list[i] & 0xffffu, list[i] >> 16);
        const vec3 point_m = imageLoad(position_m, sampled * kStride).xyz;
        const vec3 across_m = imageLoad(normal, sampled * kStride).xyz * (0.75 * view.grid.voxel_m);
        const uint behind = label_at(point_m - across_m), before = label_at(point_m + across_m);
        imageStore(map_label, sampled, uvec4(behind != kNoLabel ? behind : before));
    }
}
