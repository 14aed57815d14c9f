#pragma once

#include <string>

#include "engine/graph/frame_graph.h"

namespace patina {

/// A list of records, in no particular order, and a dispatch over it of gpu::kRecordGroup items a group.
struct RecordList {
    graph::BufferId list;  ///< u32: count, then record ids
    graph::BufferId arguments;
};

/// An empty one; lib/records/record_list.glsl appends to it.
RecordList create_record_list(graph::FrameGraph& frame, const std::string& name, uint64_t capacity);

/// The parts of empty ones: a list, and in one buffer the arguments of `count` dispatches, 16 bytes each. A pass that
/// appends to several lists binds one buffer fewer for each.
graph::BufferId create_list(graph::FrameGraph& frame, const std::string& name, uint64_t capacity);
graph::BufferId create_list_arguments(graph::FrameGraph& frame, const std::string& name, uint32_t count);

}  // namespace patina
