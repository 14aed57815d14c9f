#pragma once

// Private to engine/vulkan and the viewer: how pictures and a user interface get into what is shown.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include <glm/glm.hpp>

#include "engine/vulkan/context.h"

namespace patina::vulkan {

/// What is drawn into: an image of a swapchain, or one of its own (ImageDesc::composed).
struct ComposeTarget {
    vk::Image image;
    vk::ImageView view;
    Extent2D extent;
    vk::Semaphore ready{};  ///< of a swapchain: signalled when the image may be drawn into; else null
    vk::Semaphore drawn{};  ///< of a swapchain: to be signalled when it was drawn; else null
};

/// Of a target's pixels: from `low` up to, not including, `high`.
struct ComposeArea {
    glm::ivec2 low{0}, high{0};
};

/// Fills targets with a background, a picture and an overlay, in an order with all other work on the device's queue.
/// Two frames are in flight; draw() waits for the one before these.
class Composer {
  public:
    /// `format`: of all targets. Throws Error where the device has no queue for graphics or lacks memory.
    Composer(const std::shared_ptr<Context>& context, vk::Format format);
    ~Composer();
    Composer(const Composer&) = delete;
    Composer& operator=(const Composer&) = delete;

    /// The render pass in which overlays are drawn: one attachment, which keeps what it holds.
    vk::RenderPass overlay_pass() const { return *pass_; }

    /// Draws. `picture`, scaled into `area`, may be null; it is in the general layout. The target's content is lost
    /// before. Afterwards it is in the general layout, or, of a swapchain, ready to be presented. Throws Error when the
    /// device was lost.
    void draw(const ComposeTarget& target, const DeviceImage* picture, const ComposeArea& area,
              const std::function<void(vk::CommandBuffer)>& overlay);

    /// Waits for all that was drawn.
    void wait();

    /// The device's time for the last of these that has finished; empty before, and without timestamps.
    const std::optional<double>& ms() const { return ms_; }

  private:
    struct Slot {
        vk::raii::CommandPool pool = nullptr;
        vk::raii::CommandBuffer commands = nullptr;
        vk::raii::QueryPool times = nullptr;
        vk::raii::Fence done = nullptr;
        vk::raii::Framebuffer framebuffer = nullptr;
        bool submitted = false;
    };
    void retire(Slot& slot);
    void record(Slot& slot, const ComposeTarget& target, const DeviceImage* picture, const ComposeArea& area,
                const std::function<void(vk::CommandBuffer)>& overlay);

    std::shared_ptr<Context> context_;
    vk::raii::RenderPass pass_ = nullptr;
    std::array<Slot, 2> slots_;
    uint64_t count_ = 0;
    std::optional<double> ms_;
};

}  // namespace patina::vulkan
