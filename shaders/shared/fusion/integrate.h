// Integration of a depth image, and of colour, into the visible blocks.
#ifndef PATINA_SHARED_INTEGRATE_H
#define PATINA_SHARED_INTEGRATE_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kIntegrateGroup = 32u;     // invocations per block
INTEROP_CONST uint kQuadsPerInvocation = 4u;  // of four voxels along x

INTEROP_END
#endif
