// Where components of a frame touch, and whether they have one colour there.
#ifndef PATINA_SHARED_CONTACTS_H
#define PATINA_SHARED_CONTACTS_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kContactSlots = 2048u;  // of the hash table, a power of two
INTEROP_CONST uint kMostContacts = kContactSlots / 4u * 3u;
INTEROP_CONST uint kClaimGroup = 32u;  // invocations, each of which looks at a column of
INTEROP_CONST uint kClaimRows = 16u;   // so many pixels
INTEROP_CONST uint kJoinFoldsGroup = 128u;
INTEROP_CONST float kContactChroma = 4095.0f;  // steps of a chromaticity

// Two components and the colours along their contact: sums of r and g over r + g + b, in steps of 1 / kContactChroma.
struct Contact {
    uint low;  // the smaller key; 0: an unused slot
    uint high;
    uint pixels;
    uint pad0;
    uint low_r;
    uint low_g;
    uint high_r;
    uint high_g;
};

struct JoinFoldsParams {
    float strong_chroma;    // from grey, of what may be joined
    float same_hue;         // sine of the largest angle, seen from grey, between its chromaticities
    float same_saturation;  // the largest difference of their distances from grey
    float least_weight;     // pixels times the square of that distance
};

INTEROP_END
#endif
