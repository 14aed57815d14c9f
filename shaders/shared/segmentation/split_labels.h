// Labels that hold two colours are split: the passes that find, start and apply such splits. See
// passes/segmentation/split_labels.h.
#ifndef PATINA_SHARED_SPLIT_LABELS_H
#define PATINA_SHARED_SPLIT_LABELS_H
#include "shared/segmentation/segment_samples.h"
#include "shared/segmentation/segments.h"
INTEROP_BEGIN

INTEROP_CONST uint kSplitGroup = 128u;        // invocations per label, and of the one workgroup that starts splits
INTEROP_CONST uint kLeastSplitSamples = 48u;  // of a label, and
INTEROP_CONST uint kLeastSplitPart = 12u;     // of its rarer colour,
INTEROP_CONST float kLeastSplitShare = 0.1f;  // also in share of all
INTEROP_CONST uint kLeastSplitAge = 12u;      // frames: sooner too few of a thing's sides were seen
INTEROP_CONST float kSplitStep =
    1.0f / 2048.0f;                   // of chromaticities: whole numbers, so that no sum depends on an order
INTEROP_CONST uint kSplitBins = 64u;  // between the least and the largest along the axis

// How a label's colours fall into two.
struct SplitProposal {
    SplitRule rule;
    uint beyond;  // samples beyond the threshold, the fewer; 0: it is not to be split
    uint pad0;
    uint pad1;
    uint pad2;
};

struct FindSplitsParams {
    VoxelGrid records;  // the observation map's grid
    uint edge_shift;
    uint labels;
    float least_apart;  // chromaticities of the two colours
    uint stamp;         // the frame's index + 1
};

struct StartSplitsParams {
    uint stamp;  // the frame's index + 1
    uint labels;
    uint pad0;
    uint pad1;
};

struct PartRecordsParams {
    VoxelGrid voxels;
    VoxelGrid records;
    uint edge_shift;
    uint pad0;
    uint pad1;
    uint pad2;
};

INTEROP_END
#endif
