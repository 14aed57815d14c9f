// Ward's ks and alpha of segments, fitted to the observations of their voxels. See passes/specular/fit_ward.h.
#ifndef PATINA_SHARED_WARD_FIT_H
#define PATINA_SHARED_WARD_FIT_H
#include "shared/reflectance/reflectance.h"
#include "shared/segmentation/segment_samples.h"
#include "shared/specular/segment_batch.h"
INTEROP_BEGIN

INTEROP_CONST uint kFitAlphas = 40u;         // tried for each segment
INTEROP_CONST uint kFitAlphasPerGroup = 8u;  // in one workgroup
INTEROP_CONST uint kFitAlphaSteps = 8u;      // from an alpha to half of it
INTEROP_CONST float kFitMostAlpha = 0.6f;    // the first; the last is 0.02
INTEROP_CONST float kFitBlurM = 0.0076f;  // metres of a bent surface that an observation shows at once; a voxel at most
INTEROP_CONST uint kFitGroup = 64u;       // invocations over the voxels of a segment
INTEROP_CONST uint kFitDiffuseEvery = 4u;  // fits the segment's albedo follows; with the first ones it always does
// Of a voxel that tells of gloss. Of fewer, whose views lie close together, kd is known, and hardly what changes.
INTEROP_CONST uint kFitLeastObservations = 4u;
INTEROP_CONST float kFitLeastCosine = 0.15f;  // of observations, to the viewer: what is flatter does not count

// The network is asked below it. From there on its word, a prior of alpha, hardly changes what is fitted, but for the
// alpha of what has next to no highlight, which does not show; the last it said remains.
INTEROP_CONST float kAskedBelowConfidence = 0.9f;

INTEROP_CONST uint kChooseSegmentsGroup = 128u;  // of the one workgroup that chooses

// A voxel that is fitted.
struct FitVoxel {
    uint record;     // kNoRecord: a gap
    float blur2;     // what blur adds to the alpha^2 of its highlights
    uvec2 incident;  // RecordStatus::incident
};

// For one alpha, sums over observations without the mean of their voxel, weighted.
struct FitSums {
    vec4 lobe2;    // rgb: the square of what ks multiplies, by channel; w: voxels seen near its peak
    vec4 product;  // rgb: that times the colour
    vec4 color2;   // rgb: the square of the colour; w: how many, by channel
};

// What is kept of them by label.
struct FitCurve {
    FitSums sums;
    vec4 ks;  // rgb: what they give, with the prior; 0.04 where no peak was seen
};

// What is known of a segment's material.
struct WardFit {
    vec4 ks_alpha;       // rgb, roughness
    vec4 color2_weight;  // FitSums::color2 of the alpha that is most likely
    float confidence;    // 0 to 1
    float deviation;     // of observations from the model, in units of what is expected of them
    uint estimates;      // 0: none yet
    uint pad0;
    // The albedo of the whole segment, before refinement, is the one over the other.
    vec4 diffuse;  // rgb: weighted sum of light times what highlights leave of the colour it makes
    vec4 light2;   // rgb: of the light's square; 0: not known
    // Of a metal or a mirror whose highlights tell too little: what mirrored surroundings tell. rgb: ks; w: roughness,
    // 0: none of it.
    vec4 mirrored;
};

// What of a segment changed since it was estimated last.
struct SegmentProgress {
    uint changes;    // of its records' observations
    uint estimated;  // stamp of the frame that did it, 0: never
    uint since;      // of the SegmentLabel: a label that is handed out anew is another object
    uint pad0;
};

struct FitParams {
    VoxelGrid records;      // the observation map's grid
    uint edge_shift;        // of the observation map
    uint labels;            // of the tables
    uint materials;         // entries of the table
    uint position_version;  // of the lights
    float memory;           // the share of the earlier frames' sums that is kept
    uint pad0;
    uint pad1;
    uint pad2;
};

struct ChooseSegmentsParams {
    uint stamp;      // the frame's index + 1
    uint labels;     // of the tables
    uint materials;  // entries of the table
    uint capacity;   // of the batch
};

INTEROP_END
#endif
