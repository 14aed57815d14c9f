// Observed voxels that leave the device and come back, by block: passes/observation/stream_records.h.
#ifndef PATINA_SHARED_STREAM_RECORDS_H
#define PATINA_SHARED_STREAM_RECORDS_H
#include "shared/fusion/stream_blocks.h"
#include "shared/reflectance/reflectance.h"
INTEROP_BEGIN

// All that the device has of a record but for its observations.
struct StreamedRecord {
    VoxelRecord record;  // on its way back, block_key is the block's place in the list of blocks
    uint seen;           // as ObservationMapIds
    uint changed;
    uvec2 albedo;
    uvec2 visibility;
    RecordStatus status;
    uint around;  // as RecordSurroundings
    uint pad0;
    uint pad1;
    uint pad2;
};

// What leaves; a pass that lists it appends to both lists.
struct LeavingCount {
    uint blocks;
    uint records;
};

struct LeaveRecordsParams {
    VoxelGrid voxels;  // the voxel map's, whose blocks' coordinates the region is about
    StreamRegion region;
    uint edge_shift;  // of the observation map
    uint pad0;
    uint pad1;
    uint pad2;
};

struct ReturnRecordsParams {
    VoxelGrid records;  // the observation map's grid
    uint edge_shift;
    uint record_capacity;
    uint block_count;   // blocks that come back
    uint record_count;  // and their records
};

// How far the list of records that come back got places.
struct ReturnedCount {
    uint claimed;  // places taken, from the first record of the list on
    uint unused;   // of these, places of records whose block found none, or was there
};

struct CopyRecordsParams {
    uint chunk_shift;  // record r lies in chunk r >> chunk_shift
    uint count;        // records in the list, at most
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
