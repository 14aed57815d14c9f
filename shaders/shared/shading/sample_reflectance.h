// Reflectance at points of the surface, wherever they are.
#ifndef PATINA_SHARED_SAMPLE_REFLECTANCE_H
#define PATINA_SHARED_SAMPLE_REFLECTANCE_H
#include "shared/reflectance/reflectance.h"
INTEROP_BEGIN

INTEROP_CONST uint kSampleGroup = 64u;

struct SampleReflectanceParams {
    VoxelGrid grid;   // the observation map's
    uint edge_shift;  // of the observation map
    uint points;
    uint materials;  // entries of the table
    uint pad0;
};

// What is known of a point.
struct SampledReflectance {
    vec4 kd;     // rgb; a: 1 where records know it, 0.5 where only their segment does, else all is 0
    uint label;  // 0: none
    uint pad0;
    uint pad1;
    uint pad2;
};

INTEROP_END
#endif
