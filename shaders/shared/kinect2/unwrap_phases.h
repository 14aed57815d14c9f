#ifndef PATINA_SHARED_KINECT2_UNWRAP_PHASES_H
#define PATINA_SHARED_KINECT2_UNWRAP_PHASES_H
#include "shared/kinect2/infrared.h"
INTEROP_BEGIN

INTEROP_CONST uint kUnwrapPhasesRows = 4u;  // pixels of a column that an invocation takes

struct UnwrapPhasesParams {
    float exponent;       // a neighbour at the distance d in phase weighs exp2(exponent * d)
    float min_square;     // of a phasor's length: shorter neighbours do not weigh
    float max_distance;   // summed over a pixel's neighbours; from it on the pixel is at an edge
    float min_amplitude;  // of each frequency
    float min_sum;        // of the three amplitudes
    float slope;          // log2 of the largest residual is slope * log2(largest amplitude) + offset, within limits
    float offset;
    float min_residual;
    float max_residual;
    uint pad0;
    uint pad1;
    uint pad2;
};

INTEROP_END
#endif
