#pragma once

// Private to the graph's execution: what turns a compiled frame into Vulkan commands.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/frame_graph.h"
#include "engine/graph/runner.h"
#include "engine/vulkan/context.h"

namespace patina::graph {

/// The sizes and formats of one frame shape's transient resources. Equal needs of memory do not imply equal ones.
class TransientSizes {
  public:
    TransientSizes(const FrameGraph& frame, const Plan& plan);

    /// True when the frame, of the description these were made for, asks for the same.
    bool fit(const FrameGraph& frame) const;

    const std::optional<uint64_t>& bytes(uint32_t resource) const { return bytes_[resource]; }
    const std::optional<ImageShape>& shape(uint32_t resource) const { return shapes_[resource]; }

  private:
    std::vector<std::optional<uint64_t>> bytes_;     ///< per resource; placed buffers only
    std::vector<std::optional<ImageShape>> shapes_;  ///< per resource; placed images only
};

/// The device memory that the transient resources of all frame shapes share: one block for buffers, one for images,
/// each as large as the largest shape needs. Shapes may share it as frames share it: every frame begins with a barrier
/// that orders all its accesses behind all of the frames before, whatever resources these used the memory through.
class TransientMemory {
  public:
    bool holds(const Plan& plan) const;
    /// Replaces the blocks that are too small for the plan. A block is freed once no resource is placed in it, so
    /// resources of shapes should be let go before. Throws Error when memory runs out; what was replaced is then gone.
    void make_room(vulkan::Device& device, const Plan& plan);
    uint64_t bytes() const;

    const vulkan::MemoryRef& buffers() const { return buffers_; }
    const vulkan::MemoryRef& images() const { return images_; }

  private:
    vulkan::MemoryRef buffers_, images_;  ///< null where no shape needs any
};

/// The transient resources of one frame shape: buffers and images placed in the memory that all shapes share.
class Transients {
  public:
    Transients(vulkan::Device& device, const CompiledFrame& compiled, const TransientSizes& sizes,
               const TransientMemory& memory);

    const vulkan::BufferRef& buffer(uint32_t resource) const { return buffers_[resource]; }
    const vulkan::ImageRef& image(uint32_t resource) const { return images_[resource]; }

  private:
    std::vector<vulkan::BufferRef> buffers_;
    std::vector<vulkan::ImageRef> images_;
};

/// Descriptor sets by what they bind. A frame that binds what an earlier one did finds its set here and writes nothing.
class DescriptorCache {
  public:
    explicit DescriptorCache(vulkan::Device& device) : device_(device) {}

    struct Part {
        const vulkan::ShaderBinding* binding;
        std::vector<const vulkan::Buffer*> buffers;  ///< as many as the binding's count, or
        const vulkan::DeviceImage* image = nullptr;
    };
    vk::DescriptorSet find(const vulkan::Shader& shader, const vulkan::Pipeline& pipeline,
                           const std::vector<Part>& parts);

    /// Drops all sets when they have become many, after waiting for the device. To be called between frames.
    void trim();

  private:
    vk::DescriptorSet allocate(vk::DescriptorSetLayout layout);
    void write(vk::DescriptorSet set, const std::vector<Part>& parts);

    vulkan::Device& device_;
    std::vector<vk::raii::DescriptorPool> pools_;
    std::map<std::vector<uint64_t>, vk::DescriptorSet> sets_;
    std::vector<uint64_t> key_;  ///< of the last look-up; kept for its memory
};

/// A copy to the host whose bytes are there once the frame has finished.
struct PendingRead {
    Staging staging;
    std::function<void(const std::byte*)> deliver;

    void complete() { deliver(staging.mapped); }
};

/// Where a frame's commands go.
struct RecordInto {
    const vk::raii::CommandBuffer& commands;
    const vk::raii::QueryPool* queries;  ///< with room for two of every pass; null without timestamps
    std::vector<std::string>& timed_passes;
    std::vector<PendingRead>& reads;
    std::function<Staging(uint64_t)> stage_download;
};

void record(vulkan::Context& context, const FrameGraph& frame, const CompiledFrame& compiled,
            const Transients& transients, DescriptorCache& descriptors, RecordInto& into);

}  // namespace patina::graph
