#include "passes/model/record_list.h"

namespace patina {

RecordList create_record_list(graph::Frame& frame, const std::string& name, uint64_t capacity) {
    return {frame.fill(frame.create_buffer(name, (1 + capacity) * sizeof(uint32_t)), 0, sizeof(uint32_t)),
            frame.fill(frame.create_buffer(name + "_arguments", 16), 1)};
}

}  // namespace patina
