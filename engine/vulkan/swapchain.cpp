#include "engine/vulkan/swapchain.h"

#include <algorithm>

namespace patina::vulkan {

namespace {

/// A window system that does not answer within this time shows nothing now; whoever draws tries again later.
constexpr uint64_t kPatience_ns = 100'000'000;

/// Eight bits a channel, not encoded by the device. Every device that presents has one of them.
vk::SurfaceFormatKHR choose_format(const std::vector<vk::SurfaceFormatKHR>& offered, const std::string& device) {
    for (const vk::Format wanted : {vk::Format::eB8G8R8A8Unorm, vk::Format::eR8G8B8A8Unorm}) {
        const auto found = std::ranges::find(offered, wanted, &vk::SurfaceFormatKHR::format);
        if (found != offered.end()) return *found;
    }
    throw Error("the device '", device, "' offers ", offered.size(), " formats for the window, none of 8 bits");
}

/// The newest picture without waiting for the screen, where there is such a mode: reconstruction goes on meanwhile.
vk::PresentModeKHR choose_mode(const std::vector<vk::PresentModeKHR>& offered) {
    for (const auto wanted : {vk::PresentModeKHR::eMailbox, vk::PresentModeKHR::eImmediate})
        if (std::ranges::find(offered, wanted) != offered.end()) return wanted;
    return vk::PresentModeKHR::eFifo;
}

}  // namespace

Swapchain::Swapchain(const std::shared_ptr<Context>& context, const MakeSurface& make_surface) : context_(context) {
    guarded("opening a window", [&] {
        VkSurfaceKHR surface = VK_NULL_HANDLE;
        const auto result = static_cast<vk::Result>(make_surface(*context->instance(), &surface));
        if (result != vk::Result::eSuccess)
            throw Error("the window system made no surface for the window: ", vk::to_string(result));
        surface_ = vk::raii::SurfaceKHR(context->instance(), surface);
        const vk::raii::PhysicalDevice& physical = context->physical();
        if (!physical.getSurfaceSupportKHR(context->queue_family(), *surface_))
            throw Error("the device '", context->caps().name, "' cannot show pictures in this window");
        format_ = choose_format(physical.getSurfaceFormatsKHR(*surface_), context->caps().name);
        mode_ = choose_mode(physical.getSurfacePresentModesKHR(*surface_));
    });
}

Swapchain::~Swapchain() {
    try {
        context_->device().waitIdle();
    } catch (const std::exception&) {
        // A lost device shows nothing any more.
    }
}

void Swapchain::make(Extent2D window) {
    const auto limits = context_->physical().getSurfaceCapabilitiesKHR(*surface_);
    // Where the surface has a size of its own, images have that; else they may have the window's.
    extent_ = limits.currentExtent.width == UINT32_MAX
                  ? Extent2D{std::clamp(window.width, limits.minImageExtent.width, limits.maxImageExtent.width),
                             std::clamp(window.height, limits.minImageExtent.height, limits.maxImageExtent.height)}
                  : Extent2D{limits.currentExtent.width, limits.currentExtent.height};
    window_ = window;
    if (extent_.area() == 0) return;
    context_->device().waitIdle();
    uint32_t count = std::max(limits.minImageCount + 1, 3u);
    if (limits.maxImageCount > 0) count = std::min(count, limits.maxImageCount);
    const auto usage = vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eTransferDst;
    const auto opaque = limits.supportedCompositeAlpha & vk::CompositeAlphaFlagBitsKHR::eOpaque
                            ? vk::CompositeAlphaFlagBitsKHR::eOpaque
                            : vk::CompositeAlphaFlagBitsKHR::eInherit;
    images_.clear();
    const vk::raii::SwapchainKHR before = std::move(swapchain_);
    swapchain_ = context_->device().createSwapchainKHR({{},
                                                        *surface_,
                                                        count,
                                                        format_.format,
                                                        format_.colorSpace,
                                                        {extent_.width, extent_.height},
                                                        1,
                                                        usage,
                                                        vk::SharingMode::eExclusive,
                                                        {},
                                                        limits.currentTransform,
                                                        opaque,
                                                        mode_,
                                                        true,
                                                        *before});
    for (const VkImage image : swapchain_.getImages()) {
        Image& made = images_.emplace_back();
        made.image = image;
        made.view = context_->device().createImageView({{},
                                                        made.image,
                                                        vk::ImageViewType::e2D,
                                                        format_.format,
                                                        {},
                                                        {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}});
        made.drawn = context_->device().createSemaphore({});
    }
    ready_.clear();
    for (size_t i = 0; i < images_.size() + 2; ++i) ready_.push_back(context_->device().createSemaphore({}));
    stale_ = false;
}

std::optional<ComposeTarget> Swapchain::acquire(Extent2D window) {
    if (window.area() == 0) return std::nullopt;
    return guarded("drawing into a window", [&]() -> std::optional<ComposeTarget> {
        for (int attempt = 0; attempt < 2; ++attempt) {
            if (stale_ || window != window_) make(window);
            if (extent_.area() == 0) return std::nullopt;
            try {
                return try_acquire();
            } catch (const vk::OutOfDateKHRError&) {
                stale_ = true;
            }
        }
        return std::nullopt;
    });
}

std::optional<ComposeTarget> Swapchain::try_acquire() {
    const vk::Semaphore ready = *ready_[turn_];
    const auto [result, index] = swapchain_.acquireNextImage(kPatience_ns, ready);
    if (result != vk::Result::eSuccess && result != vk::Result::eSuboptimalKHR) return std::nullopt;
    turn_ = (turn_ + 1) % ready_.size();
    acquired_ = index;
    const Image& image = images_[index];
    return ComposeTarget{image.image, *image.view, extent_, ready, *image.drawn};
}

void Swapchain::present() {
    guarded("showing a picture", [&] {
        const vk::Semaphore drawn = *images_[acquired_].drawn;
        vk::PresentInfoKHR info;
        info.setWaitSemaphores(drawn).setSwapchains(*swapchain_).setImageIndices(acquired_);
        try {
            if (context_->queue().presentKHR(info) == vk::Result::eSuboptimalKHR) stale_ = true;
        } catch (const vk::OutOfDateKHRError&) {
            stale_ = true;
        }
    });
}

}  // namespace patina::vulkan
