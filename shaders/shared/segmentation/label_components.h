// Connected components of a picture, by union-find over runs: pixels next to each other in one row that are connected,
// within 32 pixels that start at a multiple of 32.
#ifndef PATINA_SHARED_LABEL_COMPONENTS_H
#define PATINA_SHARED_LABEL_COMPONENTS_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kRunGroup = 64u;  // words

// How 32 pixels of a row are connected, one bit each.
struct RunWord {
    uint inside;  // belongs to a component
    uint left;    // is connected to the pixel on its left
    uint up;      // and to the one above
};

struct LabelComponentsParams {
    uvec2 extent;      // pixels
    uint row_words;    // words a row
    float jump_m;      // neighbours are connected where their depths differ by at most jump_m + jump_slope * the
    float jump_slope;  // larger depth
    uint pad0;
    uint pad1;
    uint pad2;
};

INTEROP_END
#endif
