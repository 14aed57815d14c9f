#include "tools/viewer/make_display.h"

#include "tools/viewer/file_display.h"
#include "tools/viewer/window_display.h"

namespace patina::tools {

namespace {

constexpr double kVideoFps = 30;

}  // namespace

std::unique_ptr<Display> make_display(const ViewerOptions& options, const std::string& title,
                                      const std::vector<std::filesystem::path>& inputs) {
    if (options.offscreen.empty()) return std::make_unique<WindowDisplay>(title, options.extent);
    return std::make_unique<FileDisplay>(options.offscreen, options.extent, kVideoFps, inputs);
}

}  // namespace patina::tools
