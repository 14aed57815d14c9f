// Ray casting of the volume.
#ifndef PATINA_SHARED_RAYCAST_H
#define PATINA_SHARED_RAYCAST_H
#include "shared/fusion/visible_blocks.h"
INTEROP_BEGIN

INTEROP_CONST uint kRaycastGroupX = 8u;
INTEROP_CONST uint kRaycastGroupY = 8u;
INTEROP_CONST uint kMaxRaySteps = 512u;       // a ray through 8 m of allocated space takes fewer
INTEROP_CONST float kUnknownStepVox = 3.6f;   // through space without a block: less than the narrowest truncation band
INTEROP_CONST uint kMaxAttempts = 12u;        // marches and refinements of one ray
INTEROP_CONST float kAcceptedStepVox = 1.0f;  // a refinement that moves the hit no farther ends at it
INTEROP_CONST float kLongestStepVox = 4.0f;   // one that moves it farther shows that the ray passes by
INTEROP_CONST float kLeastFacing = 0.25f;     // cosine between a ray and a surface that was met from unknown space

INTEROP_END
#endif
