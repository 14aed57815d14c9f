// Which cells of a grid are in use (shared/reflectance/occupancy.h). Functions without bindings.
#ifndef PATINA_LIB_OCCUPANCY_GLSL
#define PATINA_LIB_OCCUPANCY_GLSL
#include "shared/reflectance/occupancy.h"

// The bit of a cell's cube of 8 cells.
uint bit_of_cube(ivec3 cell) {
    const uvec3 low = uvec3(cell >> 3) & 127u;
    return low.x | low.y << 7 | low.z << 14;
}

// A cell's own bit. The bits of a cube of 2 cells are a byte, those of one of 4 cells two words.
uint bit_of_cell(ivec3 cell) {
    const uvec3 cube = uvec3(cell >> 3) & 31u, within = uvec3(cell) & 7u;
    const uvec3 apart = (within & 1u) | (within & 2u) << 2 | (within & 4u) << 4;
    return (cube.x | cube.y << 5 | cube.z << 10) << 9 | apart.x | apart.y << 1 | apart.z << 2;
}

// n of the largest cube of 2^n cells around one without any in use, up to 3; -1 where the cell itself may be. `cubes`
// is the word of bit_of_cube(), `four` are the words of the cell's cube of 4 cells.
int empty_cube(ivec3 cell, uint cubes, uvec2 four) {
    const uint of_cell = bit_of_cell(cell), word = (of_cell & 32u) == 0u ? four.x : four.y;
    const int within_two = (word >> (of_cell & 31u) & 1u) == 0u ? 0 : -1;
    const int within_four = (word >> (of_cell & 24u) & 0xffu) == 0u ? 1 : within_two;
    const int within_eight = (four.x | four.y) == 0u ? 2 : within_four;
    return (cubes >> (bit_of_cube(cell) & 31u) & 1u) == 0u ? 3 : within_eight;
}

// The same for a member of a buffer.
#define EMPTY_CUBE(occupancy, cell)                     \
    empty_cube(                                         \
        cell, occupancy.cubes[bit_of_cube(cell) >> 5u], \
        uvec2(occupancy.cells[bit_of_cell(cell) >> 6u << 1u], occupancy.cells[bit_of_cell(cell) >> 6u << 1u | 1u]))

// Marks a bit of a member of a buffer, which mostly was marked before.
#define MARK_BIT(words, bit) \
    if ((words[(bit) >> 5u] & 1u << ((bit)&31u)) == 0u) atomicOr(words[(bit) >> 5u], 1u << ((bit)&31u));
#define MARK_CELL(occupancy, cell)                   \
    {                                                \
        MARK_BIT(occupancy.cubes, bit_of_cube(cell)) \
        MARK_BIT(occupancy.cells, bit_of_cell(cell)) \
    }

#endif
