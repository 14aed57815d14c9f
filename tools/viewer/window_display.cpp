#include "tools/viewer/window_display.h"

#include <algorithm>
#include <utility>

#define GLFW_INCLUDE_NONE
#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

namespace patina::tools {

namespace {

/// What GLFW says of its last failure; empty where it says nothing.
std::string reason() {
    const char* description = nullptr;
    glfwGetError(&description);
    return description ? std::string(": ") + description : "";
}

}  // namespace

WindowDisplay::Library::Library() {
    if (!glfwInit())
        throw Error("no window can be opened, as there is no display (--offscreen FILE draws to a file)", reason());
}

WindowDisplay::Library::~Library() { glfwTerminate(); }

void WindowDisplay::Close::operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }

WindowDisplay::WindowDisplay(const std::string& title, Extent2D extent) {
    if (!glfwVulkanSupported())
        throw Error("no window can be opened, as Vulkan does not know this display (--offscreen FILE draws to a file)",
                    reason());
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_.reset(glfwCreateWindow(static_cast<int>(extent.width), static_cast<int>(extent.height), title.c_str(),
                                   nullptr, nullptr));
    if (!window_) throw Error("no window could be opened (--offscreen FILE draws to a file)", reason());
    glfwSetWindowUserPointer(window_.get(), this);
    // The user interface calls it before it looks at a key itself. Keys that are released before it looks are lost to
    // it, so ours are kept here.
    glfwSetKeyCallback(window_.get(), [](GLFWwindow* window, int key, int, int action, int modifiers) {
        if (action == GLFW_RELEASE) return;
        const bool control = (modifiers & GLFW_MOD_CONTROL) != 0;
        if (control && key == GLFW_KEY_Q) glfwSetWindowShouldClose(window, GLFW_TRUE);
        auto* self = static_cast<WindowDisplay*>(glfwGetWindowUserPointer(window));
        self->keys_.push_back({key, control});
    });
}

WindowDisplay::~WindowDisplay() = default;

void WindowDisplay::ask(vulkan::DeviceOptions& options) const {
    uint32_t count = 0;
    const char** extensions = glfwGetRequiredInstanceExtensions(&count);
    if (!extensions) throw Error("the display cannot show what Vulkan draws", reason());
    options.surface_extensions.assign(extensions, extensions + count);
    options.graphics = true;
}

vk::Format WindowDisplay::open(vulkan::Device& device) {
    swapchain_ = std::make_unique<vulkan::Swapchain>(
        device.shared_context(), [this](VkInstance instance, VkSurfaceKHR* surface) {
            return glfwCreateWindowSurface(instance, window_.get(), nullptr, surface);
        });
    return swapchain_->format();
}

Extent2D WindowDisplay::extent() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_.get(), &width, &height);
    if (glfwGetWindowAttrib(window_.get(), GLFW_ICONIFIED)) return {};
    return {static_cast<uint32_t>(std::max(width, 0)), static_cast<uint32_t>(std::max(height, 0))};
}

void WindowDisplay::poll(double patience_s) {
    if (patience_s > 0)
        glfwWaitEventsTimeout(patience_s);
    else
        glfwPollEvents();
}

bool WindowDisplay::closed() const { return glfwWindowShouldClose(window_.get()); }

std::vector<KeyPress> WindowDisplay::take_keys() { return std::exchange(keys_, {}); }

void WindowDisplay::attach_ui() {
    float scale = 1;
    glfwGetWindowContentScale(window_.get(), &scale, nullptr);
    ImGui::GetIO().FontGlobalScale = scale;
    ImGui_ImplGlfw_InitForVulkan(window_.get(), true);
}

void WindowDisplay::begin_ui() { ImGui_ImplGlfw_NewFrame(); }

void WindowDisplay::detach_ui() { ImGui_ImplGlfw_Shutdown(); }

}  // namespace patina::tools
