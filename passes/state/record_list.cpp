#include "passes/state/record_list.h"

#include <glm/glm.hpp>

namespace patina {

graph::BufferId create_list(graph::FrameGraph& frame, const std::string& name, uint64_t capacity) {
    return frame.fill(frame.create_buffer(name, (1 + capacity) * sizeof(uint32_t)), 0, sizeof(uint32_t));
}

graph::BufferId create_list_arguments(graph::FrameGraph& frame, const std::string& name, uint32_t count) {
    return frame.fill(frame.create_buffer(name, count * sizeof(glm::uvec4)), 1);
}

RecordList create_record_list(graph::FrameGraph& frame, const std::string& name, uint64_t capacity) {
    return {create_list(frame, name, capacity), create_list_arguments(frame, name + "_arguments", 1)};
}

}  // namespace patina
