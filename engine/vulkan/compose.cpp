#include "engine/vulkan/compose.h"

namespace patina::vulkan {

namespace {

using Stage = vk::PipelineStageFlagBits2;
using AccessFlag = vk::AccessFlagBits2;

constexpr vk::ImageSubresourceRange kWholeImage(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1);
constexpr vk::ImageSubresourceLayers kWholeLayer(vk::ImageAspectFlagBits::eColor, 0, 0, 1);
constexpr std::array kBackground{0.11f, 0.11f, 0.12f, 1.0f};

/// Orders all accesses of the target, and of what it is drawn from, behind those of before.
void order(const vk::raii::CommandBuffer& commands, vk::Image target, vk::ImageLayout from, vk::ImageLayout to) {
    const auto all = AccessFlag::eMemoryRead | AccessFlag::eMemoryWrite;
    const vk::MemoryBarrier2 memory(Stage::eAllCommands, AccessFlag::eMemoryWrite, Stage::eAllCommands, all);
    const vk::ImageMemoryBarrier2 image(Stage::eAllCommands, AccessFlag::eMemoryWrite, Stage::eAllCommands, all, from,
                                        to, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, target, kWholeImage);
    vk::DependencyInfo info;
    info.setMemoryBarriers(memory);
    if (from != to) info.setImageMemoryBarriers(image);
    commands.pipelineBarrier2(info);
}

vk::ImageBlit scaled(Extent2D from, const ComposeArea& to) {
    const auto corner = [](glm::ivec2 at, int depth) { return vk::Offset3D(at.x, at.y, depth); };
    return {kWholeLayer,
            {corner({0, 0}, 0), corner({static_cast<int>(from.width), static_cast<int>(from.height)}, 1)},
            kWholeLayer,
            {corner(to.low, 0), corner(to.high, 1)}};
}

}  // namespace

Composer::Composer(const std::shared_ptr<Context>& context, vk::Format format) : context_(context) {
    guarded("preparing to draw pictures", [&] {
        using Layout = vk::ImageLayout;
        const vk::raii::Device& device = context->device();
        const vk::AttachmentDescription attachment(
            {}, format, vk::SampleCountFlagBits::e1, vk::AttachmentLoadOp::eLoad, vk::AttachmentStoreOp::eStore,
            vk::AttachmentLoadOp::eDontCare, vk::AttachmentStoreOp::eDontCare, Layout::eGeneral, Layout::eGeneral);
        const vk::AttachmentReference reference(0, Layout::eGeneral);
        vk::SubpassDescription subpass({}, vk::PipelineBindPoint::eGraphics);
        subpass.setColorAttachments(reference);
        pass_ = device.createRenderPass({{}, attachment, subpass});
        context->set_name(pass_, "compose.overlay");
        for (Slot& slot : slots_) {
            slot.pool = device.createCommandPool({vk::CommandPoolCreateFlagBits::eTransient, context->queue_family()});
            vk::raii::CommandBuffers made(device, {*slot.pool, vk::CommandBufferLevel::ePrimary, 1});
            slot.commands = std::move(made.front());
            slot.done = device.createFence({});
            if (context->caps().timestamps) slot.times = device.createQueryPool({{}, vk::QueryType::eTimestamp, 2});
        }
    });
}

Composer::~Composer() {
    try {
        wait();
    } catch (const std::exception&) {
        // A lost device has nothing left to wait for; whoever submitted to it has been told.
    }
}

void Composer::retire(Slot& slot) {
    if (!slot.submitted) return;
    const vk::raii::Device& device = context_->device();
    const auto result = device.waitForFences(*slot.done, true, UINT64_MAX);
    if (result != vk::Result::eSuccess) throw Error("waiting for a picture ended with ", vk::to_string(result));
    device.resetFences(*slot.done);
    slot.submitted = false;
    slot.framebuffer = nullptr;
    if (!*slot.times) return;
    const auto [read, ticks] =
        slot.times.getResults<uint64_t>(0, 2, 2 * sizeof(uint64_t), sizeof(uint64_t), vk::QueryResultFlagBits::e64);
    if (read == vk::Result::eSuccess)
        ms_ = static_cast<double>(ticks[1] - ticks[0]) * context_->caps().timestamp_period_ns * 1e-6;
}

void Composer::wait() {
    guarded("waiting for pictures", [&] {
        for (uint64_t i = 0; i < slots_.size(); ++i) retire(slots_[(count_ + i) % slots_.size()]);
    });
}

void Composer::draw(const ComposeTarget& target, const DeviceImage* picture, const ComposeArea& area,
                    const std::function<void(vk::CommandBuffer)>& overlay) {
    guarded("drawing a picture", [&] {
        Slot& slot = slots_[count_ % slots_.size()];
        retire(slot);
        record(slot, target, picture, area, overlay);
        const vk::SemaphoreSubmitInfo ready(target.ready, 0, Stage::eAllCommands);
        const vk::SemaphoreSubmitInfo drawn(target.drawn, 0, Stage::eAllCommands);
        const vk::CommandBufferSubmitInfo commands(*slot.commands);
        vk::SubmitInfo2 submit;
        submit.setCommandBufferInfos(commands);
        if (target.ready) submit.setWaitSemaphoreInfos(ready);
        if (target.drawn) submit.setSignalSemaphoreInfos(drawn);
        context_->queue().submit2(submit, *slot.done);
        slot.submitted = true;
        ++count_;
    });
}

void Composer::record(Slot& slot, const ComposeTarget& target, const DeviceImage* picture, const ComposeArea& area,
                      const std::function<void(vk::CommandBuffer)>& overlay) {
    using Layout = vk::ImageLayout;
    const vk::raii::CommandBuffer& commands = slot.commands;
    slot.framebuffer =
        context_->device().createFramebuffer({{}, *pass_, target.view, target.extent.width, target.extent.height, 1});
    slot.pool.reset();
    commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    if (*slot.times) {
        commands.resetQueryPool(*slot.times, 0, 2);
        commands.writeTimestamp2(Stage::eAllCommands, *slot.times, 0);
    }
    order(commands, target.image, Layout::eUndefined, Layout::eGeneral);
    commands.clearColorImage(target.image, Layout::eGeneral, vk::ClearColorValue(kBackground), kWholeImage);
    if (picture) {
        order(commands, target.image, Layout::eGeneral, Layout::eGeneral);
        commands.blitImage(*picture->object().image, Layout::eGeneral, target.image, Layout::eGeneral,
                           scaled(picture->desc().extent, area), vk::Filter::eLinear);
    }
    order(commands, target.image, Layout::eGeneral, Layout::eGeneral);
    const vk::Rect2D whole({0, 0}, {target.extent.width, target.extent.height});
    commands.beginRenderPass({*pass_, *slot.framebuffer, whole}, vk::SubpassContents::eInline);
    if (overlay) overlay(*commands);
    commands.endRenderPass();
    order(commands, target.image, Layout::eGeneral, target.drawn ? Layout::ePresentSrcKHR : Layout::eGeneral);
    if (*slot.times) commands.writeTimestamp2(Stage::eAllCommands, *slot.times, 1);
    commands.end();
}

}  // namespace patina::vulkan
