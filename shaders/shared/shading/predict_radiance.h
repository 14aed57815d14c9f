// Re-rendering: what a camera sees of the model, with its reflectance and the lights.
#ifndef PATINA_SHARED_PREDICT_RADIANCE_H
#define PATINA_SHARED_PREDICT_RADIANCE_H
#include "shared/reflectance/reflectance.h"
INTEROP_BEGIN

INTEROP_CONST uint kPredictGroupX = 32u;
INTEROP_CONST uint kPredictGroupY = 4u;
INTEROP_CONST uint kFewLights = 4u;         // up to as many are shaded without a loop
INTEROP_CONST float kNotMarched = -1.0f;    // for the part of the light that shadows leave: it is not known
INTEROP_CONST uint kLightsOfOneWord = 32u;  // a packed record holds the visibility of as many

struct IndexRecordsParams {
    VoxelGrid voxels;   // the voxel map's grid
    VoxelGrid records;  // the observation map's
    uint edge_shift;    // of the observation map
    uint pad0;
    uint pad1;
    uint pad2;
};

struct PredictRadianceParams {
    float voxel_m;    // of the observations
    uint edge_shift;  // of the observation map
    uint materials;   // entries of the table
    uint shadows;     // 0: every light reaches every surface
};

INTEROP_END
#endif
