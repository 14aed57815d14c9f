#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "tools/live/live_controls.h"
#include "tools/program/outcome.h"
#include "tools/run/run.h"

namespace patina::tools {

/// What `patina live` was asked to do.
struct LiveOptions {
    RunOptions run;                ///< its sequence is not used
    std::string source;            ///< the name of a camera; not used with `simulate`
    std::string simulate;          ///< a recording that plays as a camera would; empty: `source` is opened
    std::filesystem::path record;  ///< a recording of all frames, dropped ones included; empty: none
    /// Makes who goes along besides, such as a window, of who does already; empty: nobody.
    std::function<std::unique_ptr<RunCompanion>(const RunOptions& run, RunCompanion& live, LiveControls& controls)>
        accompany;
    double seconds = 0;  ///< after the first frame, the source is stopped; 0: it ends by itself or by the user
};

/// Reconstructs what a live source yields, and writes a run's folder as run() does. An interrupt ends the source: the
/// run is whole then. Frames that come while one is worked on are dropped but for the newest; a recording beside it has
/// all. Lights: those that were chosen; else the lighting sequence of a recording that is played. Throws as run() does.
Outcome live(const LiveOptions& options);

}  // namespace patina::tools
