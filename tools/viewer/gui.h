#pragma once

#include <memory>

#include "engine/vulkan/compose.h"
#include "tools/viewer/display.h"

namespace patina::tools {

/// Dear ImGui on a device and a display. One at a time.
class Gui {
  public:
    /// `pass`: in which it is drawn. All must outlive this. Throws Error where the device lacks memory.
    Gui(const std::shared_ptr<vulkan::Context>& context, Display& display, vk::RenderPass pass);
    ~Gui();
    Gui(const Gui&) = delete;
    Gui& operator=(const Gui&) = delete;

    /// Between these, the functions of ImGui are called.
    void begin();
    void end();

    /// Records what was drawn between them, within the render pass.
    void record(vk::CommandBuffer commands) const;

  private:
    void load_fonts();

    std::shared_ptr<vulkan::Context> context_;
    Display& display_;
    vk::raii::DescriptorPool descriptors_ = nullptr;
};

}  // namespace patina::tools
