#ifndef PATINA_SHARED_KINECT2_UNDISTORT_DEPTH_H
#define PATINA_SHARED_KINECT2_UNDISTORT_DEPTH_H
#include "shared/kinect2/infrared.h"
INTEROP_BEGIN

struct UndistortDepthParams {
    float min_mm;  // nearer and farther readings are dropped
    float max_mm;
    float min_amplitude;  // the mean that the deviation is divided by is at least this
    float max_deviation;  // of the amplitudes around a pixel, over their mean
    float near_step_mm;   // from the nearest neighbour
    float far_step_mm;    // from the farthest neighbour
    float max_step_mm;    // the larger of both
    uint pad0;
};

INTEROP_END
#endif
