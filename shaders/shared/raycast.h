// Ray casting of the volume.
#ifndef PATINA_SHARED_RAYCAST_H
#define PATINA_SHARED_RAYCAST_H
#include "shared/visible_blocks.h"
INTEROP_BEGIN

INTEROP_CONST uint kRaycastGroupX = 8u;
INTEROP_CONST uint kRaycastGroupY = 8u;
INTEROP_CONST uint kMaxRaySteps = 512u;      // a ray through 8 m of allocated space takes fewer
INTEROP_CONST float kUnknownStepVox = 3.6f;  // through space without a block: less than the narrowest truncation band
INTEROP_CONST uint kMaxAttempts = 4u;         // brackets that a ray may find not to hold the surface
INTEROP_CONST float kMaxResidualVox = 0.05f;  // interpolated distance at an accepted hit

INTEROP_END
#endif
