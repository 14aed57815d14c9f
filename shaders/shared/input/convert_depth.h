#ifndef PATINA_SHARED_CONVERT_DEPTH_H
#define PATINA_SHARED_CONVERT_DEPTH_H
#include "shared/input/lens.h"
INTEROP_BEGIN

struct ConvertDepthParams {
    Lens lens;
    float metres_per_unit;  // of integer sources
    uint max_code;          // readings are 1 to max_code: integer units, or the bits of metres
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
