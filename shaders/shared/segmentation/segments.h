// The segments of the map: labels of 16 bits, what is known of each, and the passes that carry a frame's segments over
// to them. See passes/state/segment_table.h.
#ifndef PATINA_SHARED_SEGMENTS_H
#define PATINA_SHARED_SEGMENTS_H
#include "shared/fusion/voxel_map.h"
#include "shared/input/camera.h"
INTEROP_BEGIN

INTEROP_CONST uint kNoLabel = 0u;
INTEROP_CONST uint kMaxLabelConfidence = 255u;  // of a voxel: 8 bits
INTEROP_CONST uint kPairBuckets = 1024u;        // of the pair counters
INTEROP_CONST uint kPairWays = 4u;              // counters of one bucket
INTEROP_CONST uint kSweepFrames = 64u;          // in which every voxel block is swept once
INTEROP_CONST uint kSweepEvery = 4u;            // of so many frames one sweeps voxels, another one the observations
INTEROP_CONST uint kSweepParts = kSweepFrames / kSweepEvery;
INTEROP_CONST float kChromaSteps = 1023.0f;
INTEROP_CONST uint kMostChromaSamples = 1u << 20;  // then the sums are halved

INTEROP_CONST uint kLabelGroup = 128u;  // of a row: software devices take a group of several rows a quarter longer
INTEROP_CONST uint kStripGroupX = 32u;  // of strips
INTEROP_CONST uint kStripGroupY = 4u;
INTEROP_CONST uint kSampleStride = 2u;   // of the pixels, in x and y, whose labels the map is asked for
INTEROP_CONST uint kAskGroup = 32u;      // invocations, each of which asks for a column of
INTEROP_CONST uint kAskRows = 8u;        // so many labels
INTEROP_CONST uint kStripPixels = 8u;    // of one row, that one invocation counts
INTEROP_CONST uint kUpdateFrames = 16u;  // in which every block that stays in sight is updated once,
INTEROP_CONST uint kRestlessFrames =
    2u;  // or, while voxels near the surface have no label or another than seen, in so many,
INTEROP_CONST uint kSettledFrames = 32u;       // or, when its labels have settled: a multiple of the others
INTEROP_CONST uint kSettledConfidence = 4u;    // of every voxel near the surface in a block that has settled
INTEROP_CONST uint kSettledBlock = 1u << 31;   // of a block's stamp
INTEROP_CONST uint kRestlessBlock = 1u << 30;  // as that
INTEROP_CONST uint kUpdateLabelsGroup = 32u;   // invocations,
INTEROP_CONST uint kUpdateBlocks = 4u;         // for so many blocks, of each of which an invocation looks at
INTEROP_CONST uint kLabelQuads = 4u;           // times four voxels along x
INTEROP_CONST uint kAssignLabelsGroup = 128u;  // of the one workgroup that assigns labels
INTEROP_CONST uint kSweepGroup = 64u;          // block ids per group

// What becomes of a label. One that is retired is in nobody's way, but some voxels may still hold it: it is free once
// all have been swept since.
INTEROP_CONST uint kFreeLabel = 0u;
INTEROP_CONST uint kLiveLabel = 1u;
INTEROP_CONST uint kRetiredLabel = 2u;  // merged with a smaller one, or pruned

struct SegmentLabel {
    uint state;
    uint since;           // stamp of the frame in which it got this state
    uint seen;            // stamp of the last frame in which a segment had it
    uint voxels;          // that hold it, as of the last sweep
    uint tally;           // of the sweep that is under way
    uint chroma_samples;  // colours in the sums
    uint chroma_r;        // sums of r / (r + g + b), in steps of 1 / kChromaSteps
    uint chroma_g;
};

// A line in the plane of chromaticities (r and g over r + g + b) that parts the colours of two labels.
struct SplitRule {
    float axis_r;  // of unit length
    float axis_g;
    float threshold;  // along it
    uint beyond;      // 1: the label's own colours lie beyond it, those of its partner do not; 0: the other way round
};

// How often the segments of a frame said that two labels are one.
struct SegmentPair {
    uint labels;  // the smaller | the larger << 16
    uint count;   // 0: an unused entry
    uint stamp;   // of the last frame that said so
    uint pad0;
};

// What a segment of the frame shares with the map, in pixels. Of labels with as many pixels the smallest counts.
struct SegmentVote {
    uint best_label;
    uint best_pixels;
    uint second_label;
    uint second_pixels;
    uint known_pixels;  // that have a label
    uint pad0;
    uint pad1;
    uint pad2;
};

// One entry of the overlap table.
struct SegmentOverlap {
    uint key;  // label | segment << 16; 0: unused
    uint pixels;
};

// Counts that live on the GPU. The host reads them two frames late.
struct SegmentCounters {
    uint live;          // labels
    uint high_water;    // every label in use is below this
    uint free_head;     // the next label to hand out, an index into the ring of free labels
    uint free_labels;   // how many there are from there on
    uint created;       // over the whole run
    uint merged;        // likewise
    uint pruned;        // likewise
    uint refused;       // likewise: segments and splits that found all labels in use
    uint split;         // likewise: labels whose colours were two
    uint overflows;     // likewise: frames whose overlap table was too small; they change nothing
    uint frame_merged;  // in this frame
    uint frame_voxels;  // voxels that this frame's segments voted on
    uint frame_flips;   // of these, how many went from one label to another
    uint frame_due;     // blocks that had their turn in this frame, times kLabelQuads; of settled ones a part had it
    uint frame_seen;    // and those in sight
    uint capacity;      // labels, label 0 included, as of this frame
};

struct SegmentationParams {
    Camera color_camera;
    uvec2 extent;         // of the depth camera
    uint stamp;           // the frame's index + 1
    uint capacity;        // labels, label 0 included
    uint overlap_slots;   // a power of two
    uint given;           // 1: a segment's key is its label
    float inherit_share;  // of a segment's pixels
    uint inherit_pixels;
    float merge_share;  // of a segment's pixels, for its second label
    uint merge_count;
    float merge_chroma;  // the largest difference of chromaticities,
    uint new_pixels;
    uint prune_voxels;
    uint prune_frames;
    float merge_brightness;  // the largest ratio of kd's luminances,
    float merge_ks;          // difference of ks
    float merge_alpha;       // and ratio of alphas
    uint pad0;
    uint pad1;
    uint pad2;
};

struct RelabelParams {
    uint edge_shift;  // of the observation map
    uint pad0;
    uint pad1;
    uint pad2;
};

struct ListDueBlocksParams {
    uint stamp;  // the frame's index + 1
    uint pad0;
    uint pad1;
    uint pad2;
};

INTEROP_END
#endif
