// A fixed number of records per segment, chosen at random, from which random samples are drawn. See
// passes/state/segment_samples.h.
#ifndef PATINA_SHARED_SEGMENT_SAMPLES_H
#define PATINA_SHARED_SEGMENT_SAMPLES_H
#include "shared/fusion/stream_blocks.h"
#include "shared/observation/observations.h"
INTEROP_BEGIN

INTEROP_CONST uint kSegmentSamples = 256u;  // records kept of a segment
INTEROP_CONST uint kSampleLevels = 16u;     // a record's level is how many leading zeros its hash has, this at most - 1
INTEROP_CONST uint kDrawGroup = 128u;       // invocations per segment

// How many records of a segment were kept, and of how many.
struct SegmentSampleCount {
    uint kept;
    uint eligible;
    uint level;           // of those with enough observations, records of this level or above were kept
    uint sparsely_level;  // and of those with fewer, which fill up what room there is
};

// The albedo of the records that were kept of a segment: whole numbers, so that the order of arrival does not matter.
struct SegmentKd {
    uint samples;  // records whose kd is known
    uint r;        // sums of kd, up to 1, in steps of 1 / kKdSteps
    uint g;
    uint b;
};
INTEROP_CONST float kKdSteps = 1023.0f;
INTEROP_CONST float kLeastKdCertainty = 0.5f;  // in every channel, of a record whose kd counts
INTEROP_CONST uint kLeastKdSamples = 8u;       // that say what a segment's albedo is

struct SegmentSampleParams {
    uint seed;
    uint labels;            // label 0 included
    uint min_observations;  // records with fewer come after those with as many
    uint draws;             // samples to draw from each segment
};

// Which records are eligible, and where they lie.
struct SampledPart {
    VoxelGrid voxels;  // the voxel map's, whose blocks' coordinates the region is about
    StreamRegion region;
    SegmentSampleParams samples;
};

// How places are found again.
struct FoundSamplesParams {
    VoxelGrid records;  // the observation map's grid
    uint edge_shift;
    uint labels;
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
