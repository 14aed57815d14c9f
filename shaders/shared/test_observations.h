// For tests of the observations: inserting streams of them, reading records wherever they lie.
#ifndef PATINA_SHARED_TEST_OBSERVATIONS_H
#define PATINA_SHARED_TEST_OBSERVATIONS_H
#include "shared/observations.h"
INTEROP_BEGIN

struct TestObservationParams {
    VoxelGrid grid;
    uint records;  // to gather, or to insert into
    uint step;     // which observation of every stream is inserted
    float merge_distance2;
    uint pad0;
};

INTEROP_END
#endif
