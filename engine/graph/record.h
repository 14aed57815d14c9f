#pragma once

// Private to the graph's execution: what turns a compiled frame into Vulkan commands.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/graph/frame.h"
#include "engine/graph/runner.h"
#include "engine/vulkan/context.h"

namespace patina::graph {

/// The physical transient resources of one frame shape: two blocks of memory, and buffers and images placed in them.
class Transients {
  public:
    Transients(vulkan::Device& device, const Frame& frame, const Plan& plan);

    /// True when the frame, of the description these were made for, asks for the same sizes and formats: equal needs of
    /// memory do not imply that.
    bool fit(const Frame& frame) const;

    const vulkan::BufferRef& buffer(uint32_t resource) const { return buffers_[resource]; }
    const vulkan::ImageRef& image(uint32_t resource) const { return images_[resource]; }
    uint64_t bytes() const { return bytes_; }

  private:
    uint64_t bytes_ = 0;
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

void record(vulkan::Context& context, const Frame& frame, const CompiledFrame& compiled, const Transients& transients,
            DescriptorCache& descriptors, RecordInto& into);

}  // namespace patina::graph
