// Which blocks of observed voxels leave (shared/observation/stream_records.h). The includer declares, before it
// includes this, BlockKeys, RecordTable and a LeaveRecordsParams `params`.
#ifndef PATINA_LIB_LEAVING_RECORDS_GLSL
#define PATINA_LIB_LEAVING_RECORDS_GLSL
#include "lib/map/accepted_key.glsl"
#include "lib/map/stream_region.glsl"
#include "lib/records/observations.glsl"

bool is_outside(uint key) { return key != kEmptyKey && !stays(params.voxels, params.region, key); }

uint records_of(uint block) {
    const uint voxels = 1u << 3u * params.edge_shift;
    uint records = 0u;
    for (uint i = 0u; i < voxels; ++i) records += record_table[block * voxels + i] < kNewRecord ? 1u : 0u;
    return records;
}

#endif
