// For tests of the observations: inserting streams of them, reading records wherever they lie.
#ifndef PATINA_SHARED_TEST_OBSERVATIONS_H
#define PATINA_SHARED_TEST_OBSERVATIONS_H
#include "shared/observation/observations.h"
INTEROP_BEGIN

struct TestObservationParams {
    VoxelGrid grid;
    uint records;  // to gather, to insert into, or to find
    uint step;     // which observation of every stream is inserted; or the map's edge shift
    float merge_distance2;
    uint pad0;
};

INTEROP_END
#endif
