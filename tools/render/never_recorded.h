#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "sensor/pose.h"
#include "tools/program/sequence_options.h"
#include "tools/report/output_folder.h"

namespace patina::tools {

/// Renders what `patina synth --novel` recorded of a sequence's scene from the model of a finished run: to
/// `out`/novel/NNNNNN.exr the views of `truth`/novel, to `out`/relit/NNNNNN.exr those of `truth`/relit under its lamps,
/// with the channels of a run's frames. `run`: the run's options, with the map that it kept. `truth_from_run`: of the
/// worlds. `on_view` is told how many views are through, and of how many. Throws Error where the map is of a run that
/// did not come to its end, or a file cannot be read.
void render_never_recorded(const SequenceOptions& run, const std::filesystem::path& truth,
                           const RigidTransform& truth_from_run, OutputFolder& out,
                           const std::function<void(uint32_t done, uint32_t total)>& on_view);

}  // namespace patina::tools
