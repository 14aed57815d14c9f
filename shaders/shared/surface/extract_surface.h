// Marching cubes on the voxel map. See passes/surface/extract_surface.h.
#ifndef PATINA_SHARED_EXTRACT_SURFACE_H
#define PATINA_SHARED_EXTRACT_SURFACE_H
#include "shared/fusion/voxel_map.h"
INTEROP_BEGIN

INTEROP_CONST uint kSurfaceGroup = 128u;
INTEROP_CONST uint kBlockWords = 16u;  // one bit per voxel, 4 rows of 8 to a word: voxel i is bit i & 31 of word i >> 5
INTEROP_CONST uint kBlockEdgeWords = 48u;   // one bit per lattice edge: axis, then the voxel at its lower end
INTEROP_CONST uint kNeighbourStride = 32u;  // per block: 27 ids of the blocks around it, x fastest; then its key
INTEROP_CONST uint kOwnKey = 27u;           // where in that list the key is
INTEROP_CONST uint kCaseStride = 8u;        // u32 per marching cubes case: how many triangles, then each of them
INTEROP_CONST uint kMaxCaseTriangles = 5u;
INTEROP_CONST uint kCornerBits = 3u;       // an edge of a cell is the corner at its lower end | axis << 3
INTEROP_CONST uint kCaseEdgeBits = 5u;     // a triangle is three such edges, the first in the lowest bits
INTEROP_CONST float kLeastShare = 0.001f;  // vertices keep this share of an edge from its ends, so that none coincide

// Push constants of all passes.
struct SurfaceParams {
    VoxelGrid grid;
    uint items;           // blocks, vertices or triangles that the pass goes through
    uint no_block;        // stands for a block that is not there: one more than the largest id, with arrays of zeros
    uint first_vertex;    // of the batch
    uint first_triangle;  // of the batch
};

// A word of the edge bits, and the number of vertices of its block before it.
struct EdgeWord {
    uint bits;
    uint offset;
};

// Elements of one block.
struct BlockElements {
    uint vertices;
    uint triangles;
};

// What one invocation makes a vertex or a triangle from.
struct SurfaceElement {
    uint block;
    uint code;  // vertex: voxel | axis << 9; triangle: voxel | case << 9 | number within the case << 17
};

INTEROP_END
#endif
