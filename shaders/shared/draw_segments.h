// From numbered components to a picture of segments, and what is measured of each.
#ifndef PATINA_SHARED_DRAW_SEGMENTS_H
#define PATINA_SHARED_DRAW_SEGMENTS_H
#include "shared/camera.h"
INTEROP_BEGIN

struct DrawSegmentsParams {
    uvec2 extent;  // pixels
    uint row_words;
    uint min_pixels;
};

struct ClaimEdgesParams {
    vec4 focal_center_px;  // fx, fy, cx, cy
    uvec2 extent;          // pixels
    float noise_floor_m;   // sigma(z) = noise_floor_m + noise_per_m * z^2
    float noise_per_m;     // 1 / m
    float step_floor_m;    // a pixel joins a segment where its distance from the tangent plane there is at most
    float step_sigmas;     // step_floor_m + step_sigmas * sigma(z)
    int reach_px;          // how far away a segment is looked for
    uint pad0;
};

struct MeasureSegmentsParams {
    Camera camera;
    uint row_words;
    uint pad0;
    uint pad1;
    uint pad2;
};

struct CountGivenParams {
    uvec2 extent;  // pixels
    uint row_words;
    uint ids;  // ids from this on are unknown
};

INTEROP_END
#endif
