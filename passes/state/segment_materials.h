#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "engine/graph/enlargement.h"
#include "engine/graph/frame_graph.h"
#include "engine/graph/state_visitor.h"
#include "engine/vulkan/device.h"
#include "shared/reflectance/reflectance.h"

namespace patina {

/// The specular part of each segment's material by label: Ward's ks and alpha (paper, Eq. 2-4). Label 0 and labels that
/// were never set have none. Those beyond the capacity have theirs from when it has grown.
class SegmentMaterials {
  public:
    static constexpr uint32_t kMaxCapacity = 65536;  ///< labels have 16 bits

    /// Throws Error when the capacity is 0 or above kMaxCapacity, or memory runs out.
    SegmentMaterials(vulkan::Device& device, uint32_t capacity);

    /// Sets the material of a label; its version changes only if the material does. Throws Error for label 0, a label
    /// of kMaxCapacity or more, ks that are negative or not finite, or an alpha that is not above 0.
    void set(uint32_t label, glm::vec3 ks, float alpha);

    /// Announces that there will be at least `capacity` labels; new ones have no material but what was set before.
    void enlarge(graph::Enlargement& enlargement, uint32_t capacity);

    /// gpu::SegmentMaterial[capacity()], with what was set; uploads it where that is news to the device.
    graph::BufferId import(graph::FrameGraph& frame);

    void visit(graph::StateVisitor& visitor);

    uint32_t capacity() const { return capacity_; }

  private:
    std::vector<gpu::SegmentMaterial>
        materials_;  ///< those that were set; more than the capacity only where one of those has no place yet
    uint32_t capacity_;
    vulkan::BufferRef buffer_;
    uint32_t changes_ = 0;
    bool uploaded_ = false;
};

}  // namespace patina
