#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "tools/commands/commands.h"
#include "tools/run/run.h"
#include "tools/viewer/viewer_options.h"

namespace patina::tools {

/// What `patina run` takes.
struct RunArguments {
    RunOptions run;
    SequenceArguments sequence;
    std::optional<std::filesystem::path> extends;  ///< the folder whose map the run begins from
    bool no_map = false;                           ///< no state is kept
    std::optional<std::filesystem::path> resume;   ///< the folder whose map the run goes on from; none: it begins
    bool window = false;                           ///< the scene is shown while it grows; so it is off screen
    ViewerOptions viewer;

    bool shows() const { return window || !viewer.offscreen.empty(); }
};

/// Adds the options. Both must live until the command line is parsed.
void declare(CLI::App& command, RunArguments& arguments);

/// Where a run keeps its state.
std::filesystem::path map_in(const std::filesystem::path& run_folder);

/// Has the run keep its state, unless the user does not want that.
void name_map(RunArguments& arguments);

/// The arguments of the run that a map is of, as if they were given now: enters the folder that it was started in.
/// Throws Error where there is no map, or that folder is gone.
std::shared_ptr<RunArguments> kept_arguments(const std::filesystem::path& map);

}  // namespace patina::tools
