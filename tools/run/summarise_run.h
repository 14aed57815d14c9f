#pragma once

#include "export/write_glb.h"
#include "reconstruction/session/session_core.h"
#include "tools/report/run_summary.h"
#include "tools/run/run.h"

namespace patina::tools {

/// What run.json and report.html say of a run, but for its ending, its times and what was compared: of the settings,
/// the frames, the pools, the passes. `scene` is what became of the mesh. Asks nothing of the device, which may be
/// lost.
RunSummary summarise(const RunOptions& options, SessionCore& session, const GlbSummary& scene);

/// Adds what the keyframes counted. Waits for the device; throws Error where it was lost.
void add_keyframes(RunSummary& summary, SessionCore& session);

}  // namespace patina::tools
