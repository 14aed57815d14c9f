// Where the materials of segments lie, with which probability. See passes/specular/bound_materials.h.
#ifndef PATINA_SHARED_MATERIAL_BOUNDS_H
#define PATINA_SHARED_MATERIAL_BOUNDS_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kBoundsGroup = 64u;  // invocations of a segment
INTEROP_CONST uint kBoundsRow = 1024u;  // segments in a row of groups
INTEROP_CONST uint kBoundsLevels = 4u;  // probabilities, in rising order: 0.5, 0.8, 0.9, 0.95

// The interval of one probability; a kd that is not known has the interval from 0 to 1.
struct MaterialBounds {
    vec4 kd_low;   // rgb; w: how sure ks and alpha are, 0 to 1
    vec4 kd_high;  // rgb
    vec4 ks_alpha_low;
    vec4 ks_alpha_high;
};

struct BoundMaterialsParams {
    uint labels;  // of the tables
};

INTEROP_END
#endif
