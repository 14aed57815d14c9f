// Bits of voxels, 32 to a word (shared/surface/extract_surface.h), and the same bits one voxel further: marching cubes
// looks at 32 cells at a time. The includer declares the blocks' neighbours:
//   NEIGHBOUR(i)    uint, entry i of the list
#ifndef PATINA_LIB_SURFACE_WORDS_GLSL
#define PATINA_LIB_SURFACE_WORDS_GLSL
#include "shared/surface/extract_surface.h"

// The block that lies by an offset of -1, 0 or 1 a block along each axis from `block`.
uint neighbour_block(uint block, ivec3 offset) {
    return NEIGHBOUR(block * kNeighbourStride + uint(offset.z * 9 + offset.y * 3 + offset.x + 13));
}

// The index of the word that lies by an offset (blocks in x, words in y, voxels in z; each -1, 0 or 1) from word `word`
// of `block`.
uint word_index(uint block, uint word, ivec3 offset) {
    const ivec2 at = ivec2(word & 1u, word >> 1) + offset.yz;
    return neighbour_block(block, ivec3(offset.x, at.x >> 1, at.y >> 3)) * kBlockWords +
           uint((at.y & 7) << 1 | (at.x & 1));
}

// Each voxel's neighbour in +x, +y, -x or -y: of a word, and the next one in that direction.
uint next_in_x(uint word, uint next) { return (word >> 1 & 0x7f7f7f7fu) | (next << 7 & 0x80808080u); }
uint next_in_y(uint word, uint next) { return word >> 8 | next << 24; }
uint last_in_x(uint word, uint last) { return (word << 1 & 0xfefefefeu) | (last >> 7 & 0x01010101u); }
uint last_in_y(uint word, uint last) { return word << 8 | last >> 24; }

// The bits at corners (0, 0), (1, 0), (0, 1), (1, 1) in x, y of every cell, from the words at these offsets.
uvec4 at_corners(uint here, uint x, uint y, uint xy) {
    const uint here_y = next_in_y(here, y);
    return uvec4(here, next_in_x(here, x), here_y, next_in_x(here_y, next_in_y(x, xy)));
}
uint all_of(uvec4 words) { return words.x & words.y & words.z & words.w; }
uint any_of(uvec4 words) { return words.x | words.y | words.z | words.w; }

// The eight corners' bits of 32 cells: `low` those at z, `high` those at z + 1. WORD(i) loads word i.
#define CORNERS_AT(WORD, block, word, dz)                                                                      \
    at_corners(WORD(word_index(block, word, ivec3(0, 0, dz))), WORD(word_index(block, word, ivec3(1, 0, dz))), \
               WORD(word_index(block, word, ivec3(0, 1, dz))), WORD(word_index(block, word, ivec3(1, 1, dz))))

// The marching cubes case of the cell at `bit`: bit i is set where corner i (x | y << 1 | z << 2) is inside.
uint case_of_cell(uvec4 low, uvec4 high, uint bit) {
    const uvec4 l = (low >> bit & 1u) << uvec4(0u, 1u, 2u, 3u);
    const uvec4 h = (high >> bit & 1u) << uvec4(4u, 5u, 6u, 7u);
    return any_of(l | h);
}

#endif
