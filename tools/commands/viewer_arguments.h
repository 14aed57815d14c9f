#pragma once

#include <CLI/CLI.hpp>

#include "tools/viewer/viewer_options.h"

namespace patina::tools {

/// Adds what all commands take that show frames: --offscreen, --layer, --extent NAME, --no-panels. `options` must live
/// until the command line is parsed. `extent`: the name of the option for the size.
void declare_viewer(CLI::App& command, ViewerOptions& options, const char* extent);

}  // namespace patina::tools
