#pragma once

#include <cstdint>

#include "engine/graph/frame_graph.h"

namespace patina {

/// Makes the new places of a pool free that grew from `before` to `capacity` of them: below those that were free
/// before, which are popped first. `name` is the pass's. `counters` holds gpu::MapCounters, whose count of the table's
/// keys becomes 0, as the table is filled anew. Ids are replaced by what is written.
void add_grow_free_list(graph::FrameGraph& frame, const char* name, graph::BufferId& free_list,
                        graph::BufferId& counters, uint32_t before, uint32_t capacity);

}  // namespace patina
