// Dispatches over a batch of segments whose number only the device knows. See passes/state/segment_batch.h.
#ifndef PATINA_SHARED_SEGMENT_BATCH_H
#define PATINA_SHARED_SEGMENT_BATCH_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kBatchGroup = 64u;  // invocations a group, of passes that take a number of items per segment

// How many groups a pass takes: a segment has some images, which are divided into tiles, each of which takes some
// items.
struct BatchWork {
    uint images;           // per segment
    uint images_per_tile;  //
    uint items_per_tile;
    uint rows;  // groups in y
};

struct BatchParams {
    uint passes;
    uint capacity;  // segments
};

INTEROP_END
#endif
