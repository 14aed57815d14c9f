// Integration of a depth image, and of colour, into the visible blocks.
#ifndef PATINA_SHARED_INTEGRATE_H
#define PATINA_SHARED_INTEGRATE_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kIntegrateGroup = 128u;  // invocations per block, four voxels each

INTEROP_END
#endif
