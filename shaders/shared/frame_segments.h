// The segments of one frame: a table that an image of segment numbers refers to.
#ifndef PATINA_SHARED_FRAME_SEGMENTS_H
#define PATINA_SHARED_FRAME_SEGMENTS_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kMaxFrameSegments = 4095u;         // 12 bits; number 0 means unknown
INTEROP_CONST float kSegmentFractionsPerM = 1024.0f;  // unit of the fractions of positions

// What is known of one segment. Sums over its pixels are integers, so that they do not depend on the order of addition:
// the mean of x is (whole_x_m + fraction_x / kSegmentFractionsPerM) / pixels.
struct FrameSegment {
    uint pixels;          // 0: there is no such segment
    uint key;             // its given id where ids were given, else 1 + y * width + x of its first pixel
    uint touches_border;  // 1 where one of its pixels lies at the picture's border
    uint pad0;
    uint min_x;  // bounding box in pixels, inclusive
    uint min_y;
    uint max_x;
    uint max_y;
    int whole_x_m;  // sums of floor(position), world
    int whole_y_m;
    int whole_z_m;
    int pad1;
    uint fraction_x;  // sums of position - floor(position)
    uint fraction_y;
    uint fraction_z;
    uint pad2;
};

struct FrameSegmentCount {
    uint segments;         // numbered 1 .. segments, in the order of their keys
    uint too_small;        // components that were dropped because they have too few pixels
    uint beyond_capacity;  // and those, last in order, that found no place in the table
    uint pad0;
};

INTEROP_END
#endif
