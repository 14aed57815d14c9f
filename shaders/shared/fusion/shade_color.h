// The fused colour at raycast surface points.
#ifndef PATINA_SHARED_SHADE_COLOR_H
#define PATINA_SHARED_SHADE_COLOR_H
#include "shared/fusion/voxel_map.h"
INTEROP_BEGIN

INTEROP_CONST uint kShadeColorGroup = 8u;  // invocations per side

INTEROP_END
#endif
