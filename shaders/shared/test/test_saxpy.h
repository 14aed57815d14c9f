// For the engine's own tests: y = a x + y, with a count.
#ifndef PATINA_SHARED_TEST_SAXPY_H
#define PATINA_SHARED_TEST_SAXPY_H
#include "shared/interop.h"
INTEROP_BEGIN

struct SaxpyParams {
    float a;
    uint count;
};

INTEROP_END
#endif
