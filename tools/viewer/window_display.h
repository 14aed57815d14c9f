#pragma once

#include <memory>
#include <string>

#include "engine/vulkan/swapchain.h"
#include "tools/viewer/display.h"

struct GLFWwindow;

namespace patina::tools {

/// A window on the desktop. Its functions are called on the main thread, as GLFW asks.
class WindowDisplay : public Display {
  public:
    /// Opens it, `extent` screen units large. Throws Error where there is no display, or no Vulkan for it.
    WindowDisplay(const std::string& title, Extent2D extent);
    ~WindowDisplay() override;

    void ask(vulkan::DeviceOptions& options) const override;
    vk::Format open(vulkan::Device& device) override;
    Extent2D extent() const override;
    void poll(double patience_s) override;
    bool closed() const override;
    std::vector<KeyPress> take_keys() override;
    void attach_ui() override;
    void begin_ui() override;
    void detach_ui() override;
    std::optional<vulkan::ComposeTarget> begin() override { return swapchain_->acquire(extent()); }
    void show() override { swapchain_->present(); }
    void finish() override {}
    bool wants_all() const override { return false; }

  private:
    struct Library {
        Library();
        ~Library();
    };
    Library library_;
    struct Close {
        void operator()(GLFWwindow* window) const;
    };
    std::unique_ptr<GLFWwindow, Close> window_;
    std::vector<KeyPress> keys_;
    std::unique_ptr<vulkan::Swapchain> swapchain_;  // before the window goes
};

}  // namespace patina::tools
