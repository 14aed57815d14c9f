#include "engine/graph/record.h"

#include <deque>

namespace patina::graph {

using Stage = vk::PipelineStageFlagBits2;
using AccessFlag = vk::AccessFlagBits2;

TransientSizes::TransientSizes(const FrameGraph& frame, const Plan& plan)
    : bytes_(plan.placements.size()), shapes_(plan.placements.size()) {
    for (uint32_t i = 0; i < plan.placements.size(); ++i) {
        if (!plan.placements[i]) continue;
        if (frame.description().resources[i].kind == ResourceKind::kBuffer) {
            bytes_[i] = frame.bytes(BufferId{{i}});
        } else {
            shapes_[i] = frame.shape(ImageId{{i}});
        }
    }
}

bool TransientSizes::fit(const FrameGraph& frame) const {
    for (uint32_t i = 0; i < bytes_.size(); ++i) {
        if (bytes_[i] && *bytes_[i] != frame.bytes(BufferId{{i}})) return false;
        if (shapes_[i] && *shapes_[i] != frame.shape(ImageId{{i}})) return false;
    }
    return true;
}

namespace {

uint64_t bytes_of(const vulkan::MemoryRef& memory) { return memory ? memory->bytes : 0; }

}  // namespace

bool TransientMemory::holds(const Plan& plan) const {
    return plan.buffer_arena.bytes <= bytes_of(buffers_) && plan.image_arena.bytes <= bytes_of(images_);
}

void TransientMemory::make_room(vulkan::Device& device, const Plan& plan) {
    const auto enlarge = [&](vulkan::MemoryRef& block, const char* name, uint64_t bytes, bool for_images) {
        if (bytes <= bytes_of(block)) return;
        block.reset();  // before the larger one is made, so that memory need not hold both
        block = device.create_memory(name, bytes, for_images);
    };
    enlarge(buffers_, "graph.buffers", plan.buffer_arena.bytes, false);
    enlarge(images_, "graph.images", plan.image_arena.bytes, true);
}

uint64_t TransientMemory::bytes() const { return bytes_of(buffers_) + bytes_of(images_); }

Transients::Transients(vulkan::Device& device, const CompiledFrame& compiled, const TransientSizes& sizes,
                       const TransientMemory& memory) {
    const std::vector<Resource>& resources = compiled.description.resources;
    buffers_.resize(resources.size());
    images_.resize(resources.size());
    for (uint32_t i = 0; i < resources.size(); ++i) {
        const std::optional<Placement>& placement = compiled.plan.placements[i];
        if (const auto& bytes = sizes.bytes(i)) {
            buffers_[i] = device.create_placed_buffer({resources[i].name, *bytes}, memory.buffers(), placement->offset);
        } else if (const auto& shape = sizes.shape(i)) {
            images_[i] = device.create_placed_image({resources[i].name, shape->extent, shape->format}, memory.images(),
                                                    placement->offset);
        }
    }
}

namespace {

vk::PipelineStageFlags2 vk_stages(uint32_t stages) {
    vk::PipelineStageFlags2 flags;
    if (stages & kStageCompute) flags |= Stage::eComputeShader;
    if (stages & kStageTransfer) flags |= Stage::eTransfer;
    if (stages & kStageIndirect) flags |= Stage::eDrawIndirect;
    return flags;
}

vk::AccessFlags2 vk_accesses(uint32_t accesses) {
    vk::AccessFlags2 flags;
    if (accesses & kAccessStorageRead) flags |= AccessFlag::eShaderStorageRead;
    if (accesses & kAccessStorageWrite) flags |= AccessFlag::eShaderStorageWrite;
    if (accesses & kAccessSampledRead) flags |= AccessFlag::eShaderSampledRead;
    if (accesses & kAccessUniformRead) flags |= AccessFlag::eUniformRead;
    if (accesses & kAccessIndirectRead) flags |= AccessFlag::eIndirectCommandRead;
    if (accesses & kAccessTransferRead) flags |= AccessFlag::eTransferRead;
    if (accesses & kAccessTransferWrite) flags |= AccessFlag::eTransferWrite;
    return flags;
}

constexpr vk::ImageSubresourceRange kWholeImage(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1);
constexpr vk::ImageSubresourceLayers kWholeLayer(vk::ImageAspectFlagBits::eColor, 0, 0, 1);

/// Records one frame; lives for one call of record().
class Recorder {
  public:
    Recorder(vulkan::Context& context, const FrameGraph& frame, const CompiledFrame& compiled,
             const Transients& transients, DescriptorCache& descriptors, RecordInto& into)
        : context_(context),
          frame_(frame),
          compiled_(compiled),
          transients_(transients),
          descriptors_(descriptors),
          into_(into) {}

    void run() {
        const Plan& plan = compiled_.plan;
        if (into_.queries) {
            into_.commands.resetQueryPool(**into_.queries, 0, 2 * static_cast<uint32_t>(plan.order.size()));
        }
        size_t barrier = 0;
        for (uint32_t position = 0; position < plan.order.size(); ++position) {
            const size_t first = barrier;
            while (barrier < plan.barriers.size() && plan.barriers[barrier].before == position) ++barrier;
            record_barriers({plan.barriers.data() + first, barrier - first});
            record_timed(plan.order[position]);
        }
        if (!into_.reads.empty()) make_visible_to_host();
    }

  private:
    const vulkan::Buffer& buffer(uint32_t resource) const { return *buffers(resource).front(); }

    std::vector<vulkan::BufferRef> buffers(uint32_t resource) const {
        if (compiled_.description.resources[resource].imported) return frame_.physical(resource).buffers;
        return {transients_.buffer(resource)};
    }

    const vulkan::DeviceImage& image(uint32_t resource) const {
        if (compiled_.description.resources[resource].imported) return *frame_.physical(resource).image;
        return *transients_.image(resource);
    }

    bool is_image(uint32_t resource) const {
        return compiled_.description.resources[resource].kind == ResourceKind::kImage;
    }

    /// All barriers before one pass as a single command: one memory barrier, and one per image that starts its life.
    void record_barriers(std::span<const Barrier> barriers) {
        if (barriers.empty()) return;
        vk::MemoryBarrier2 memory;
        std::vector<vk::ImageMemoryBarrier2> images;
        for (const Barrier& b : barriers) {
            const auto source = vk_stages(b.source.stages), destination = vk_stages(b.destination.stages);
            // An image barrier speaks of accesses through that image alone; what used its memory before is covered
            // here.
            memory.srcStageMask |= source;
            memory.srcAccessMask |= vk_accesses(b.source.accesses);
            memory.dstStageMask |= destination;
            memory.dstAccessMask |= vk_accesses(b.destination.accesses);
            if (!b.discard) continue;
            images.emplace_back(source, vk_accesses(b.source.accesses), destination,
                                vk_accesses(b.destination.accesses), vk::ImageLayout::eUndefined,
                                vk::ImageLayout::eGeneral, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED,
                                *image(*b.resource).object().image, kWholeImage);
        }
        vk::DependencyInfo info;
        if (memory.srcStageMask) info.setMemoryBarriers(memory);
        info.setImageMemoryBarriers(images);
        into_.commands.pipelineBarrier2(info);
    }

    void make_visible_to_host() {
        const vk::MemoryBarrier2 barrier(Stage::eTransfer, AccessFlag::eTransferWrite, Stage::eHost,
                                         AccessFlag::eHostRead);
        vk::DependencyInfo info;
        info.setMemoryBarriers(barrier);
        into_.commands.pipelineBarrier2(info);
    }

    void record_timed(uint32_t pass) {
        const uint32_t slot = static_cast<uint32_t>(into_.timed_passes.size());
        if (into_.queries) into_.commands.writeTimestamp2(Stage::eAllCommands, **into_.queries, slot * 2);
        std::visit([&](const auto& work) { record_work(work); }, frame_.work()[pass]);
        if (!into_.queries) return;
        into_.commands.writeTimestamp2(Stage::eAllCommands, **into_.queries, slot * 2 + 1);
        into_.timed_passes.push_back(compiled_.description.passes[pass].name);
    }

    void record_work(const work::Dispatch& dispatch) {
        const vulkan::Pipeline& pipeline = context_.pipeline(*dispatch.shader, dispatch.constants);
        std::vector<DescriptorCache::Part> parts;
        for (const work::Bound& bound : dispatch.bound) {
            DescriptorCache::Part part{bound.binding, {}, nullptr};
            if (is_image(bound.resource)) {
                part.image = &image(bound.resource);
            } else {
                // A shader's chunk array is as long as the largest pool; unused places repeat the first chunk.
                const auto chunks = buffers(bound.resource);
                for (uint32_t i = 0; i < bound.binding->count; ++i) {
                    part.buffers.push_back(chunks[i < chunks.size() ? i : 0].get());
                }
            }
            parts.push_back(std::move(part));
        }
        const vk::raii::CommandBuffer& commands = into_.commands;
        commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline.pipeline);
        const vk::DescriptorSet set = descriptors_.find(*dispatch.shader, pipeline, parts);
        commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *pipeline.layout, 0, set, {});
        if (const uint32_t bytes = dispatch.shader->push_bytes; bytes > 0) {
            commands.pushConstants<std::byte>(*pipeline.layout, vk::ShaderStageFlagBits::eCompute, 0,
                                              vk::ArrayProxy<const std::byte>(bytes, dispatch.push.data()));
        }
        if (dispatch.indirect) {
            commands.dispatchIndirect(*buffer(*dispatch.indirect).object().buffer, dispatch.indirect_offset);
        } else if (dispatch.groups[0] > 0 && dispatch.groups[1] > 0 && dispatch.groups[2] > 0) {
            commands.dispatch(dispatch.groups[0], dispatch.groups[1], dispatch.groups[2]);
        }
    }

    void record_work(const work::Fill& fill) {
        for (const auto& chunk : buffers(fill.resource)) {
            into_.commands.fillBuffer(*chunk->object().buffer, 0,
                                      fill.bytes < chunk->bytes() ? fill.bytes : VK_WHOLE_SIZE, fill.value);
        }
    }

    void record_work(const work::Upload& upload) {
        const vk::Buffer source = *upload.staging.buffer->object().buffer;
        if (is_image(upload.resource)) {
            const Extent2D extent = image(upload.resource).desc().extent;
            const vk::BufferImageCopy region(upload.staging.offset, 0, 0, kWholeLayer, {},
                                             {extent.width, extent.height, 1});
            into_.commands.copyBufferToImage(source, *image(upload.resource).object().image, vk::ImageLayout::eGeneral,
                                             region);
        } else {
            into_.commands.copyBuffer(source, *buffer(upload.resource).object().buffer,
                                      vk::BufferCopy(upload.staging.offset, upload.offset, upload.bytes));
        }
    }

    void record_work(const work::Download& download) {
        const Staging staging = into_.stage_download(download.bytes);
        const vk::Buffer target = *staging.buffer->object().buffer;
        if (is_image(download.resource)) {
            const Extent2D whole = image(download.resource).desc().extent;
            const glm::ivec2 begin(download.pixel.value_or(glm::uvec2(0)));
            const Extent2D extent = download.pixel ? Extent2D{1, 1} : whole;
            const vk::BufferImageCopy region(staging.offset, 0, 0, kWholeLayer, {begin.x, begin.y, 0},
                                             {extent.width, extent.height, 1});
            into_.commands.copyImageToBuffer(*image(download.resource).object().image, vk::ImageLayout::eGeneral,
                                             target, region);
        } else {
            into_.commands.copyBuffer(*buffer(download.resource).object().buffer, target,
                                      vk::BufferCopy(download.offset, staging.offset, download.bytes));
        }
        into_.reads.push_back({staging, [target = download.target, bytes = download.bytes](
                                            const std::byte* mapped) mutable { target.deliver(mapped, bytes); }});
    }

    void record_work(const work::Copy& copy) {
        into_.commands.copyBuffer(*buffer(copy.source).object().buffer, *buffer(copy.destination).object().buffer,
                                  vk::BufferCopy(copy.source_offset, copy.destination_offset, copy.bytes));
    }

    vulkan::Context& context_;
    const FrameGraph& frame_;
    const CompiledFrame& compiled_;
    const Transients& transients_;
    DescriptorCache& descriptors_;
    RecordInto& into_;
};

}  // namespace

vk::DescriptorSet DescriptorCache::allocate(vk::DescriptorSetLayout layout) {
    constexpr uint32_t kSetsPerPool = 256;
    const auto try_last = [&]() -> vk::DescriptorSet {
        const vk::DescriptorSetAllocateInfo info(*pools_.back(), layout);
        // Sets live until their pool is destroyed, so the plain handles are enough.
        const auto& device = device_.context().device();
        VkDescriptorSet set = VK_NULL_HANDLE;
        const auto plain = static_cast<VkDescriptorSetAllocateInfo>(info);
        const auto result = static_cast<vk::Result>(
            device.getDispatcher()->vkAllocateDescriptorSets(static_cast<VkDevice>(*device), &plain, &set));
        return result == vk::Result::eSuccess ? vk::DescriptorSet(set) : vk::DescriptorSet();
    };
    if (!pools_.empty()) {
        if (const vk::DescriptorSet set = try_last()) return set;
    }
    const std::array sizes = {vk::DescriptorPoolSize(vk::DescriptorType::eStorageBuffer, kSetsPerPool * 16),
                              vk::DescriptorPoolSize(vk::DescriptorType::eUniformBuffer, kSetsPerPool),
                              vk::DescriptorPoolSize(vk::DescriptorType::eCombinedImageSampler, kSetsPerPool * 4),
                              vk::DescriptorPoolSize(vk::DescriptorType::eStorageImage, kSetsPerPool * 8),
                              vk::DescriptorPoolSize(vk::DescriptorType::eStorageTexelBuffer, kSetsPerPool * 16)};
    pools_.push_back(device_.context().device().createDescriptorPool({{}, kSetsPerPool, sizes}));
    device_.context().set_name(pools_.back(), text("graph.descriptors.", pools_.size() - 1));
    const vk::DescriptorSet set = try_last();
    if (!set) throw Error("a fresh descriptor pool could not hold one descriptor set");
    return set;
}

void DescriptorCache::write(vk::DescriptorSet set, const std::vector<Part>& parts) {
    std::vector<vk::WriteDescriptorSet> writes;
    // The writes point into these; a deque's elements stay where they are.
    std::deque<std::vector<vk::DescriptorBufferInfo>> buffers;
    std::deque<vk::DescriptorImageInfo> images;
    std::deque<std::vector<vk::BufferView>> views;
    for (const Part& part : parts) {
        vk::WriteDescriptorSet entry(set, part.binding->binding);
        entry.descriptorCount = part.binding->count;
        switch (part.binding->kind) {
            case vulkan::BindingKind::kStorageBuffer:
            case vulkan::BindingKind::kUniformBuffer: {
                auto& infos = buffers.emplace_back();
                for (const auto* buffer : part.buffers) infos.emplace_back(*buffer->object().buffer, 0, VK_WHOLE_SIZE);
                entry.pBufferInfo = infos.data();
                entry.descriptorType = part.binding->kind == vulkan::BindingKind::kStorageBuffer
                                           ? vk::DescriptorType::eStorageBuffer
                                           : vk::DescriptorType::eUniformBuffer;
                break;
            }
            case vulkan::BindingKind::kTexelBuffer: {
                auto& infos = views.emplace_back();
                for (const auto* buffer : part.buffers)
                    infos.push_back(buffer->object().texel_view(part.binding->format));
                entry.pTexelBufferView = infos.data();
                entry.descriptorType = vk::DescriptorType::eStorageTexelBuffer;
                break;
            }
            case vulkan::BindingKind::kSampledImage:
            case vulkan::BindingKind::kStorageImage:
                entry.pImageInfo = &images.emplace_back(device_.context().nearest_sampler(), *part.image->object().view,
                                                        vk::ImageLayout::eGeneral);
                entry.descriptorType = part.binding->kind == vulkan::BindingKind::kSampledImage
                                           ? vk::DescriptorType::eCombinedImageSampler
                                           : vk::DescriptorType::eStorageImage;
                break;
        }
        writes.push_back(entry);
    }
    device_.context().device().updateDescriptorSets(writes, {});
}

vk::DescriptorSet DescriptorCache::find(const vulkan::Shader& shader, const vulkan::Pipeline& pipeline,
                                        const std::vector<Part>& parts) {
    key_.clear();
    key_.push_back(reinterpret_cast<uintptr_t>(&shader));
    for (const Part& part : parts) {
        key_.push_back(part.binding->binding);
        if (part.image) key_.push_back(part.image->serial());
        for (const auto* buffer : part.buffers) key_.push_back(buffer->serial());
    }
    if (const auto found = sets_.find(key_); found != sets_.end()) return found->second;
    const vk::DescriptorSet set = allocate(*pipeline.set_layout);
    write(set, parts);
    sets_.emplace(key_, set);
    return set;
}

void DescriptorCache::trim() {
    constexpr size_t kMaxSets = 4096;  // frames whose resources keep changing must not fill memory
    if (sets_.size() < kMaxSets) return;
    device_.wait_idle();
    sets_.clear();
    pools_.clear();
}

void record(vulkan::Context& context, const FrameGraph& frame, const CompiledFrame& compiled,
            const Transients& transients, DescriptorCache& descriptors, RecordInto& into) {
    Recorder(context, frame, compiled, transients, descriptors, into).run();
}

}  // namespace patina::graph
