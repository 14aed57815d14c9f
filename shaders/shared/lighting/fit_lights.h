// Lamps found in what they light: samples of the observed surface, and what trial lamps would give them.
#ifndef PATINA_SHARED_FIT_LIGHTS_H
#define PATINA_SHARED_FIT_LIGHTS_H
#include "shared/observation/observations.h"
INTEROP_BEGIN

INTEROP_CONST uint kLightSamples = 4096u;       // of the surface, a power of two; and as many of its highlights
INTEROP_CONST uint kTrialLights = 64u;          // tried at once
INTEROP_CONST uint kTrialGroup = 8u;            // of them, side by side: their ways from a sample are much alike
INTEROP_CONST uint kTrialSamples = 8u;          // of a workgroup
INTEROP_CONST uint kLeastForSample = 4u;        // observations that a sampled voxel has
INTEROP_CONST float kHighlightFloor = 0.1f;     // a highlight is brighter than the rest by this pixel value
INTEROP_CONST float kHighlightShare = 0.3f;     // and by this share of it
INTEROP_CONST float kMostHighlight = 0.3f;      // from here on highlights count the same
INTEROP_CONST float kTrialLampM = 0.15f;        // a lamp's own surface is no obstacle within this
INTEROP_CONST float kLeastTrialCosine = 0.05f;  // lower lamps give a surface nothing that could be trusted

// A voxel of the observed surface.
struct LightSample {
    vec4 point_m;    // world; w: observations, 0 where there is no sample
    vec4 normal;     // unit length; w unused
    vec4 diffuse;    // rgb: linear pixel value without highlights; w unused
    vec4 highlight;  // xyz: unit direction to the viewer of the brightest observation; w: what it is brighter by
    vec4 around;     // rgb: irradiance / pi that is known to come from what is around; w: the share of all directions,
                     // by cosine, of which nothing is known, below 0 where nobody looked
};

struct SampleParams {
    VoxelGrid grid;   // of the observations
    uint edge_shift;  // of the observation map
    uint seed;        // of which voxels are samples
    uint pad0;
    uint pad1;
};

struct TrialParams {
    VoxelGrid grid;  // of the voxel map
    vec4 ball_m;     // world, radius: beyond it nothing stands in the way of a sun
    uint trials;     // how many lights are tried
    uint pad0;
    uint pad1;
    uint pad2;
};

INTEROP_END
#endif
