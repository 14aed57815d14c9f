// Sums over the records that are away from the device, by label and part of the sweep over labels. The includer
// declares
//   layout(std430, binding = n) buffer Away { SegmentAlbedo away[]; };  // kSweepParts per label
// before it includes this.
#ifndef PATINA_LIB_AWAY_ALBEDO_GLSL
#define PATINA_LIB_AWAY_ALBEDO_GLSL
#include "lib/records/segment_albedo.glsl"
#include "shared/segmentation/segments.h"

// Counts a record of a block in, or (`leaves` false) out again.
void count_away(uint block_key, VoxelRecord record, uvec2 albedo, bool leaves) {
    const uint label = record_label(record);
    const uint entry = label * kSweepParts + hash_of_key(block_key) % kSweepParts;
    if (label == 0u || entry >= uint(away.length())) return;
    const SegmentAlbedo sums = albedo_sums(record, albedo);
    const uvec4 kd = leaves ? sums.kd : 0u - sums.kd, weight = leaves ? sums.weight : 0u - sums.weight;
    for (int c = 0; c < 4; ++c) {
        if (kd[c] != 0u) atomicAdd(away[entry].kd[c], kd[c]);
        if (weight[c] != 0u) atomicAdd(away[entry].weight[c], weight[c]);
    }
}

#endif
