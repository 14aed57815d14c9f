#pragma once

#include <string>

#include "engine/graph/frame.h"

namespace patina {

/// A list of records, in no particular order, and a dispatch over it of gpu::kRecordGroup items a group.
struct RecordList {
    graph::BufferId list;  ///< u32: count, then record ids
    graph::BufferId arguments;
};

/// An empty one; lib/record_list.glsl appends to it.
RecordList create_record_list(graph::Frame& frame, const std::string& name, uint64_t capacity);

}  // namespace patina
