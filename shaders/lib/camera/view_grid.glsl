// The dense grid of block ids around a view frustum (shared/fusion/visible_blocks.h): rays find blocks in it with one
// load, where the map's table takes a hash and a search. Functions without bindings.
#ifndef PATINA_LIB_VIEW_GRID_GLSL
#define PATINA_LIB_VIEW_GRID_GLSL
#include "shared/fusion/visible_blocks.h"

const uint kOutsideGrid = 0xffffffffu;

// The cell of a block in a grid from `low` (view.grid_low.xyz) of `size` (view.grid_size.xyz) blocks, kOutsideGrid
// where it does not reach. Loops should copy both from the uniform buffer before they start: software devices do not
// hoist such loads.
uint view_grid_cell(ivec3 low, uvec3 size, ivec3 block) {
    const uvec3 at = uvec3(block - low);
    return all(lessThan(at, size)) ? (at.z * size.y + at.y) * size.x + at.x : kOutsideGrid;
}

#endif
