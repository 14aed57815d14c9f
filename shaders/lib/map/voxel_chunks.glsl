// Selection among the voxel pool's chunks. The includer declares its chunk arrays, for example
//   layout(std430, binding = n) buffer Tsdf { uvec4 quads[]; } tsdf[kMaxVoxelChunks];
// and names the chunk by a literal, as any other index into an array of buffers is an optional feature of a device.
#ifndef PATINA_LIB_VOXEL_CHUNKS_GLSL
#define PATINA_LIB_VOXEL_CHUNKS_GLSL
#include "shared/fusion/voxel_map.h"

// How many chunks the pool has. One, the most common, is compiled without a selection; chunks that are not there are
// compiled away, as software devices run through every case.
layout(constant_id = 0) const uint kVoxelChunks = 1u;

// Runs the statement DO(C) with the literal C of the chunk that holds `block`.
#define WITH_CHUNK(chunk_shift, block, DO)  \
    if (kVoxelChunks == 1u) {               \
        DO(0);                              \
    } else {                                \
        switch ((block) >> (chunk_shift)) { \
            case 0u: DO(0); break;          \
            case 1u: DO(1); break;          \
            case 2u:                        \
                if (kVoxelChunks > 2u) {    \
                    DO(2);                  \
                }                           \
                break;                      \
            case 3u:                        \
                if (kVoxelChunks > 3u) {    \
                    DO(3);                  \
                }                           \
                break;                      \
            default:                        \
                if (kVoxelChunks > 4u) {    \
                    DO(4);                  \
                }                           \
                break;                      \
        }                                   \
    }

// A block's index within its chunk.
uint index_in_chunk(uint chunk_shift, uint block) {
    return kVoxelChunks == 1u ? block : block & ((1u << chunk_shift) - 1u);
}

#endif
