// What is known of the surface that a camera sees: passes/shading/sample_coverage.h.
#ifndef PATINA_SHARED_SAMPLE_COVERAGE_H
#define PATINA_SHARED_SAMPLE_COVERAGE_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kSampleCoverageGroup = 8u;  // invocations per side

struct SampleCoverageParams {
    float voxel_m;    // of the observations
    uint edge_shift;  // of the observation map
    uint pad0;
    uint pad1;
};

INTEROP_END
#endif
