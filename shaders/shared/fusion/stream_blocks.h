// Blocks that leave the device and come back: passes/fusion/stream_blocks.h.
#ifndef PATINA_SHARED_STREAM_BLOCKS_H
#define PATINA_SHARED_STREAM_BLOCKS_H
#include "shared/fusion/voxel_map.h"
INTEROP_BEGIN

INTEROP_CONST uint kLeaveGroup = 64u;  // invocations, of passes over block ids or over a list of blocks
INTEROP_CONST uint kCopyGroup = 64u;   // invocations per block that is copied, two quads of words each

// Where blocks stay: in a box and, there, in a ball or in a cone that begins at its centre.
struct StreamRegion {
    vec4 ball_m;       // centre in the world, radius
    vec4 cone_m;       // axis, as long as the cone reaches; cosine of half its angle, above 1: there is no cone
    ivec4 low_block;   // xyz: lowest block coordinates of the box; w unused
    ivec4 high_block;  // xyz: highest ones; w unused
};

struct LeaveParams {
    VoxelGrid grid;
    StreamRegion region;
    uint most;  // blocks that leave at once
    uint pad0;
    uint pad1;
    uint pad2;
};

// Words of the counts of blocks that may leave, a buffer of kLeavingWords.
INTEROP_CONST uint kLeavingAccepted = 0u;  // blocks leave whose hash lies in the first so many bins
INTEROP_CONST uint kLeavingOutside = 1u;   // blocks outside the region
INTEROP_CONST uint kLeavingBins = 2u;      // and from here on, of them those in each of kAcceptBins bins
INTEROP_CONST uint kLeavingWords = kLeavingBins + kAcceptBins;

// A block on its way.
struct StreamedBlock {
    uint key;
    uint block;         // its id on the device; kNoBlock: it found no place there
    uint fresh;         // 1: it took that place, 0: it had it
    uint label_stamp;   // of a block of voxels: as LabelMapIds::stamps
    uint first_record;  // of a block of observed voxels: the first of its records in their list
    uint records;       // likewise: their number
};

struct StreamParams {
    uint chunk_shift;  // block b lies in chunk b >> chunk_shift
    uint count;        // blocks in the list, at most
    uint pad0;
    uint pad1;
};

struct ReturnParams {
    VoxelGrid grid;
    uint count;  // blocks that come back
    uint pad0;
    uint pad1;
    uint pad2;
};

INTEROP_END
#endif
