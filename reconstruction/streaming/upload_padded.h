#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/graph/frame_graph.h"

namespace patina {

/// Few sizes of lists, so that frames keep their shape.
inline uint32_t padded(size_t items) {
    uint32_t size = 64;
    while (size < items) size *= 4;
    return size;
}

/// In a buffer of `size` elements, of which those behind the values hold anything.
template <class T>
graph::BufferId upload_padded(graph::FrameGraph& graph, const char* name, const std::vector<T>& values, uint64_t size) {
    const graph::BufferId id = graph.create_buffer(name, size * sizeof(T));
    return graph.upload_bytes(id, 0, std::as_bytes(std::span(values)), true);
}

}  // namespace patina
