#pragma once

// Private to engine/vulkan and the viewer: pictures on their way to a window.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "engine/vulkan/compose.h"

namespace patina::vulkan {

/// Makes the surface of a window: the window system's call.
using MakeSurface = std::function<VkResult(VkInstance, VkSurfaceKHR*)>;

/// The images that a window shows one after the other. They are made anew whenever the window has another size, or the
/// window system asks for it. Not in sRGB: whoever draws encodes.
class Swapchain {
  public:
    /// The device was opened with DeviceOptions::graphics and the surface's extensions. Throws Error where it cannot
    /// present into this window.
    Swapchain(const std::shared_ptr<Context>& context, const MakeSurface& make_surface);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    vk::Format format() const { return format_.format; }

    /// The next image of a window of so many pixels, to be drawn into and then presented. Empty where there is nothing
    /// to draw into: the window is minimised, or the window system is not ready. Throws Error when the device or the
    /// window was lost.
    std::optional<ComposeTarget> acquire(Extent2D window);

    /// Shows what was drawn into the image that acquire() gave last.
    void present();

  private:
    struct Image {
        vk::Image image;
        vk::raii::ImageView view = nullptr;
        vk::raii::Semaphore drawn = nullptr;
    };
    void make(Extent2D window);
    std::optional<ComposeTarget> try_acquire();

    std::shared_ptr<Context> context_;
    vk::raii::SurfaceKHR surface_ = nullptr;
    vk::SurfaceFormatKHR format_;
    vk::PresentModeKHR mode_ = vk::PresentModeKHR::eFifo;
    vk::raii::SwapchainKHR swapchain_ = nullptr;
    std::vector<Image> images_;
    std::vector<vk::raii::Semaphore> ready_;  ///< in turn; more than images are ever waited for
    size_t turn_ = 0;
    uint32_t acquired_ = 0;
    Extent2D window_, extent_;  ///< what the images were made for, and what they have
    bool stale_ = true;         ///< is to be made anew
};

}  // namespace patina::vulkan
