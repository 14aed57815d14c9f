#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "sensor/pose.h"
#include "tools/program/sequence_options.h"
#include "tools/report/output_folder.h"

namespace patina::tools {

/// Which views of a sequence's scene are rendered.
struct FinishedViews {
    std::filesystem::path sequence;
    std::vector<uint32_t> recorded;  ///< frames, whose poses are lines of truth/trajectory.txt
    bool never_recorded = false;     ///< those of truth/novel, and those of truth/relit under its lamps
};

/// Renders views of the model of a finished run to `out`/finished, `out`/novel and `out`/relit as NNNNNN.exr, with the
/// channels of a run's frames and the numbers of truth's. `run`: the run's options, with the map that it kept.
/// `truth_from_run`: of the worlds. `on_view` is told how many views are through, and of how many. Throws Error where
/// the map is of a run that did not come to its end, a frame has no true pose, or a file cannot be read.
void render_finished_views(const SequenceOptions& run, const FinishedViews& views, const RigidTransform& truth_from_run,
                           OutputFolder& out, const std::function<void(uint32_t done, uint32_t total)>& on_view);

}  // namespace patina::tools
