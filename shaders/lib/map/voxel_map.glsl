// Keys, hashes and packing of the sparse volume (shared/fusion/voxel_map.h). Functions without bindings.
#ifndef PATINA_LIB_VOXEL_MAP_GLSL
#define PATINA_LIB_VOXEL_MAP_GLSL
#include "shared/fusion/voxel_map.h"

const ivec3 kKeyHalfRange = ivec3(1024, 512, 1024);  // 11 + 10 + 11 bits: 82 x 41 x 82 m at 4 cm blocks

// The key of a block, kEmptyKey outside the range (and for the one corner block whose key would be that).
uint key_of_block(VoxelGrid grid, ivec3 block) {
    const uvec3 biased = uvec3(block - grid.origin_block.xyz + kKeyHalfRange);
    const bool inside = all(lessThan(biased, uvec3(2 * kKeyHalfRange)));
    return inside ? biased.x | biased.y << 11 | biased.z << 21 : kEmptyKey;
}

ivec3 block_of_key(VoxelGrid grid, uint key) {
    const ivec3 biased = ivec3(key & 0x7ffu, key >> 11 & 0x3ffu, key >> 21);
    return biased - kKeyHalfRange + grid.origin_block.xyz;
}

// A full mixer of 32 bits (public domain, found by C. Wellons' search): compact rooms differ in a few low bits only.
uint hash_of_key(uint key) {
    key ^= key >> 16;
    key *= 0x7feb352du;
    key ^= key >> 15;
    key *= 0x846ca68bu;
    return key ^ key >> 16;
}

// A voxel is snorm16 distance | u16 weight << 16. Weight 0: never seen.
float voxel_sdf(uint voxel) { return float(int(voxel << 16) >> 16) * (1.0 / 32767.0); }
uint voxel_weight(uint voxel) { return voxel >> 16; }
uint pack_voxel(float sdf, uint weight) {
    return (uint(int(floor(clamp(sdf, -1.0, 1.0) * 32767.0 + 0.5))) & 0xffffu) | weight << 16;
}

// A voxel's colour is 11 + 11 + 10 bits, the square root of linear / kColorRange: dark tones keep their precision, and
// steps are finer than those of 8-bit sRGB. 0: no colour yet; black is stored as the smallest red.
const vec3 kColorLevels = vec3(2047.0, 2047.0, 1023.0);
vec3 voxel_color(uint color) {
    const vec3 root = vec3(color & 0x7ffu, color >> 11 & 0x7ffu, color >> 22) / kColorLevels;
    return root * root * kColorRange;
}

// Rounds up or down by chance, so that a running average does not stall where its steps become smaller than a level;
// `dither` is a hash of the voxel and the frame.
uint pack_color(vec3 linear, uint dither) {
    const vec3 chance = vec3(dither & 0x3ffu, dither >> 10 & 0x3ffu, dither >> 20 & 0x3ffu) * (1.0 / 1024.0);
    const uvec3 level = uvec3(sqrt(clamp(linear * (1.0 / kColorRange), 0.0, 1.0)) * kColorLevels + chance);
    const uvec3 root = min(level, uvec3(kColorLevels));
    return max(root.x | root.y << 11 | root.z << 22, 1u);
}

// The item of a list that this group of an indirect dispatch works on.
uint group_item(uvec3 group) { return group.y * kGroupsPerRow + group.x; }

// Rows of groups enough for item `group` of a list, whose first group the arguments (a buffer's array) begin with: it
// finds the list empty if it is.
#define GROW_ARGUMENTS(arguments, group)                                                          \
    {                                                                                             \
        atomicMax(arguments[0], min((group) + 1u, kGroupsPerRow));                                \
        if ((group) % kGroupsPerRow == 0u) atomicMax(arguments[1], (group) / kGroupsPerRow + 1u); \
    }

#endif
