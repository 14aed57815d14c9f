#pragma once

#include <filesystem>
#include <memory>

#include "tools/report/drawing.h"
#include "tools/report/video.h"
#include "tools/viewer/display.h"

namespace patina::tools {

/// Frames in files, without a display: a video (.mp4, .avi), or pictures (.png), where a row of # in the name becomes
/// the number of the frame. Without one, the last frame alone is written.
class FileDisplay : public Display {
  public:
    /// Throws Error for another extension, and where a file is one of `inputs` or among them.
    FileDisplay(const std::filesystem::path& file, Extent2D extent, double fps,
                const std::vector<std::filesystem::path>& inputs);

    void ask(vulkan::DeviceOptions& options) const override { options.graphics = true; }
    vk::Format open(vulkan::Device& device) override;
    Extent2D extent() const override { return extent_; }
    void poll(double) override {}
    bool closed() const override { return false; }
    std::vector<KeyPress> take_keys() override { return {}; }
    void attach_ui() override {}
    void begin_ui() override;
    void detach_ui() override {}
    std::optional<vulkan::ComposeTarget> begin() override;
    void show() override;
    void finish() override;
    bool wants_all() const override { return true; }

  private:
    std::filesystem::path numbered(uint32_t number) const;
    void write_picture(const std::filesystem::path& file, const Drawing& drawing) const;

    std::filesystem::path file_;
    Extent2D extent_;
    std::vector<std::filesystem::path> inputs_;
    std::optional<VideoWriter> video_;
    vulkan::Device* device_ = nullptr;  ///< from open() on
    vulkan::ImageRef image_;
    std::optional<Drawing> last_;  ///< where it alone is to be written
    uint32_t count_ = 0;
};

}  // namespace patina::tools
