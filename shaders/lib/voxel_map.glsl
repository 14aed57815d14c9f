// Keys, hashes and packing of the sparse volume (shared/voxel_map.h). Functions without bindings.
#ifndef PATINA_LIB_VOXEL_MAP_GLSL
#define PATINA_LIB_VOXEL_MAP_GLSL
#include "shared/voxel_map.h"

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
    return (uint(int(round(clamp(sdf, -1.0, 1.0) * 32767.0))) & 0xffffu) | weight << 16;
}

// A voxel's colour is 3 x u16, the square root of linear / kColorRange (dark tones keep their precision), and a u16 weight.
vec3 voxel_color(uvec2 packed) {
    const vec3 root = vec3(packed.x & 0xffffu, packed.x >> 16, packed.y & 0xffffu) * (1.0 / 65535.0);
    return root * root * kColorRange;
}
uint color_weight(uvec2 packed) { return packed.y >> 16; }
uvec2 pack_color(vec3 linear, uint weight) {
    const uvec3 root = uvec3(sqrt(clamp(linear * (1.0 / kColorRange), 0.0, 1.0)) * 65535.0 + 0.5);
    return uvec2(root.x | root.y << 16, root.z | weight << 16);
}

// The item of a list that this group of an indirect dispatch works on.
uint group_item(uvec3 group) { return group.y * kGroupsPerRow + group.x; }

#endif
