#pragma once

#include <filesystem>
#include <memory>

#include "patina/image.h"
#include "tools/live/live_controls.h"
#include "tools/run/run.h"
#include "tools/viewer/layers.h"

namespace patina::tools {

/// How frames are shown.
struct ViewerOptions {
    std::filesystem::path offscreen;  ///< FileDisplay; empty: a window is opened
    Extent2D extent{1280, 800};
    Layer layer = Layer::kColor;  ///< at first
    bool panels = true;
};

/// What `patina view` was asked to show.
struct ViewOptions {
    std::filesystem::path input;  ///< a map, or a run's folder that has one
    ViewerOptions viewer;
    uint32_t orbit = 1;  ///< off screen: so many frames, once around the scene; 1: from the last pose
    DeviceChoice device;
    bool quiet = false;
};

/// Shows a map until the user closes the window, or as many frames as were asked for off screen. Throws Error where
/// this program was built without a viewer, the map cannot be read, there is no display, or the device was lost.
void view(const ViewOptions& options);

/// Goes along with a run and shows its scene as it grows. `inner`: who else goes along; may be null.
/// `live`: of a live source, which ends when the user closes the window; null: the run is interrupted then. Both must
/// outlive this. Throws Error as view() does.
std::unique_ptr<RunCompanion> show_run(const ViewerOptions& options, const RunOptions& run, RunCompanion* inner,
                                       LiveControls* live);

}  // namespace patina::tools
