// Which records a segment keeps (shared/segmentation/segment_samples.h). Functions without bindings.
#ifndef PATINA_LIB_SEGMENT_SAMPLES_GLSL
#define PATINA_LIB_SEGMENT_SAMPLES_GLSL
#include "lib/map/stream_region.glsl"
#include "lib/records/observations.glsl"
#include "lib/records/record_hash.glsl"
#include "shared/segmentation/segment_samples.h"

// Of the voxel, not of its record's number, which differs from run to run.
uint sample_hash(VoxelRecord record, uint seed) {
    return hash_of_key(hash_of_voxel(record.block_key, voxel_in_block(record)) ^ seed);
}
// Half of all records have level 0, a quarter has level 1, and so on.
uint sample_level(uint hash) { return min(31u - uint(findMSB(hash | 1u)), kSampleLevels - 1u); }

bool is_eligible(VoxelRecord record, SampledPart part) {
    const uint label = record_label(record);
    return label != 0u && label < part.samples.labels && observation_count(record) > 0u &&
           stays(part.voxels, part.region, record.block_key);
}
// Few observations tell of kd, but hardly of gloss.
bool is_sparsely_observed(VoxelRecord record, SampledPart part) {
    return observation_count(record) < part.samples.min_observations;
}

#endif
