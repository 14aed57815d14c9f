// Selection among the voxel pool's chunks. The includer declares its chunk arrays, for example
//   layout(std430, binding = n) buffer Tsdf { uvec4 quads[]; } tsdf[kMaxTsdfChunks];
// and names the chunk by a literal, as any other index into an array of buffers is an optional feature of a device.
#ifndef PATINA_LIB_VOXEL_CHUNKS_GLSL
#define PATINA_LIB_VOXEL_CHUNKS_GLSL
#include "shared/voxel_map.h"

// How many chunks the pool has. One, the most common, is compiled without a selection; chunks that are not there are compiled
// away, as software devices run through every case.
layout(constant_id = 0) const uint kTsdfChunks = 1u;
layout(constant_id = 1) const uint kColorChunks = 1u;

// Run the statement DO(C) with the literal C of the chunk that holds `block`.
#define WITH_TSDF_CHUNK(grid, block, DO)                     \
    if (kTsdfChunks == 1u) {                                 \
        DO(0);                                               \
    } else {                                                 \
        switch ((block) >> (grid).chunk_shift) {             \
            case 0u: DO(0); break;                           \
            case 1u: DO(1); break;                           \
            case 2u: if (kTsdfChunks > 2u) { DO(2); } break; \
            default: if (kTsdfChunks > 3u) { DO(3); } break; \
        }                                                    \
    }

#define WITH_COLOR_CHUNK(grid, block, DO)                     \
    if (kColorChunks == 1u) {                                 \
        DO(0);                                                \
    } else {                                                  \
        switch ((block) >> ((grid).chunk_shift - 1u)) {       \
            case 0u: DO(0); break;                            \
            case 1u: DO(1); break;                            \
            case 2u: if (kColorChunks > 2u) { DO(2); } break; \
            case 3u: if (kColorChunks > 3u) { DO(3); } break; \
            case 4u: if (kColorChunks > 4u) { DO(4); } break; \
            case 5u: if (kColorChunks > 5u) { DO(5); } break; \
            case 6u: if (kColorChunks > 6u) { DO(6); } break; \
            default: if (kColorChunks > 7u) { DO(7); } break; \
        }                                                     \
    }

// A block's index within its chunk.
uint index_in_tsdf_chunk(VoxelGrid grid, uint block) {
    return kTsdfChunks == 1u ? block : block & ((1u << grid.chunk_shift) - 1u);
}
uint index_in_color_chunk(VoxelGrid grid, uint block) {
    return kColorChunks == 1u ? block : block & ((1u << (grid.chunk_shift - 1u)) - 1u);
}

#endif
