#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/viewer/display.h"
#include "tools/viewer/viewer_options.h"

namespace patina::tools {

/// A window of that title, or files that are none of `inputs`. Throws Error as WindowDisplay and FileDisplay do.
std::unique_ptr<Display> make_display(const ViewerOptions& options, const std::string& title,
                                      const std::vector<std::filesystem::path>& inputs);

}  // namespace patina::tools
