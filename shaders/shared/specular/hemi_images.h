// What a segment looks like from all sides: the network's input. See passes/specular/hemi_images.h.
#ifndef PATINA_SHARED_HEMI_IMAGES_H
#define PATINA_SHARED_HEMI_IMAGES_H
#include "shared/segmentation/segment_samples.h"
INTEROP_BEGIN

INTEROP_CONST uint kHemiSamples = 25u;             // voxels drawn from a segment (paper, Section 3.6)
INTEROP_CONST uint kHemiSide = 15u;                // pixels
INTEROP_CONST uint kHemiPixels = 225u;             // kHemiSide^2
INTEROP_CONST uint kLeastHemiObservations = 5u;    // of a voxel that is drawn
INTEROP_CONST uint kHemiGroup = 32u;               // invocations per image
INTEROP_CONST uint kHemiPixelsPerInvocation = 8u;  // kHemiGroup times these cover an image
INTEROP_CONST uint kParabolicMap = 0u;             // as HemisphereMap
INTEROP_CONST uint kOrthogonalMap = 1u;

struct HemiParams {
    uint seed;
    uint capacity;     // segments of the batch
    uint labels;       // of the samples' table
    uint map;          // kParabolicMap, kOrthogonalMap
    uint chunk_shift;  // of records
};

INTEROP_END
#endif
