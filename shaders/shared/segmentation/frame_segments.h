// The segments of one frame: a table that an image of segment numbers refers to.
#ifndef PATINA_SHARED_FRAME_SEGMENTS_H
#define PATINA_SHARED_FRAME_SEGMENTS_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kMaxFrameSegments = 4095u;  // 12 bits; number 0 means unknown

// What is known of one segment.
struct FrameSegment {
    uint pixels;          // 0: there is no such segment
    uint key;             // its given id where ids were given, else 1 + y * width + x of its first pixel
    uint touches_border;  // 1 where one of its pixels lies at the picture's border
    uint pad0;
};

struct FrameSegmentCount {
    uint segments;         // numbered 1 .. segments, in the order of their keys
    uint too_small;        // components that were dropped because they have too few pixels
    uint beyond_capacity;  // and those, last in order, that found no place in the table
    uint pad0;
};

INTEROP_END
#endif
