// Light that reaches a camera by random samples: from lamps that have a size, from afar, by way of other surfaces.
#ifndef PATINA_SHARED_GATHER_LIGHT_H
#define PATINA_SHARED_GATHER_LIGHT_H
#include "shared/input/camera.h"
#include "shared/scenes/scene.h"
INTEROP_BEGIN

INTEROP_CONST uint kGatherLightSamples = 4u;  // per dispatch at most: none may run for long

struct GatherLightParams {
    Camera camera;
    uvec2 seed;
    uint frame_index;
    uint first_sample;  // of this dispatch
    uint sample_count;  // of this dispatch
    uint samples;       // of all dispatches
    uint bounces;
    uint pad0;
};

INTEROP_END
#endif
