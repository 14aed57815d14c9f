#pragma once

#include <optional>
#include <vector>

#include "engine/vulkan/compose.h"

namespace patina::tools {

/// A key that was pressed, in the numbers of GLFW.
struct KeyPress {
    int key = 0;
    bool control = false;
};

/// Where the viewer's frames are shown, and where its user's doings come from.
class Display {
  public:
    virtual ~Display() = default;

    /// What a device has to have for it.
    virtual void ask(vulkan::DeviceOptions& options) const = 0;
    /// Begins to show frames that are drawn on the device; once, before all of what follows. Returns the format of what
    /// is drawn into. Nothing is shown once the device has gone.
    virtual vk::Format open(vulkan::Device& device) = 0;

    virtual Extent2D extent() const = 0;  ///< pixels; without any there is nothing to draw: it is minimised

    /// Takes what the user did; where that is nothing, waits up to `patience_s`.
    virtual void poll(double patience_s) = 0;
    virtual bool closed() const = 0;  ///< by the user
    /// Those since the last call.
    virtual std::vector<KeyPress> take_keys() = 0;

    /// The user interface begins (`ImGui::CreateContext` was called), begins a frame, ends.
    virtual void attach_ui() = 0;
    virtual void begin_ui() = 0;
    virtual void detach_ui() = 0;

    /// What is to be drawn into; empty: nothing now. Then show() shows it.
    virtual std::optional<vulkan::ComposeTarget> begin() = 0;
    virtual void show() = 0;

    /// Nothing more is shown. Throws Error where frames could not be written.
    virtual void finish() = 0;

    /// Whether all frames are to be shown, whatever that costs; else as many as there is time for.
    virtual bool wants_all() const = 0;
};

}  // namespace patina::tools
