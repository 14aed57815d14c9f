#pragma once

#include "engine/graph/frame.h"
#include "passes/model/map_access.h"
#include "passes/model/network.h"
#include "passes/model/segment_batch.h"

namespace patina {

/// How activations and weights of a batch are read fastest on this device, within its limits.
MapAccess preferred_network_access(const vulkan::DeviceCaps& caps, const Network& network, uint32_t capacity);

/// Runs a network on the images of all segments of a batch. `images`: vec4 [segment][sample][y][x], three channels and
/// an unused one for a network of three; quads_of(channels) vec4 a pixel in general. Returns the last layer's
/// activations, vec4 [segment][sample][y][x][quad] as far as they are there; undefined beyond the segments of the
/// batch. Throws Error when `images` or the batch's capacity do not fit.
graph::BufferId add_run_network(graph::Frame& frame, Network& network, graph::BufferId images,
                                const SegmentBatch& batch, MapAccess access);

}  // namespace patina
