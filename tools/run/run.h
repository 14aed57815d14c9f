#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "export/scene_files.h"
#include "reconstruction/session/session_core.h"
#include "tools/program/outcome.h"
#include "tools/program/sequence_options.h"
#include "tools/report/run_summary.h"

namespace patina::tools {

/// What `patina run` was asked to do.
struct RunOptions : SequenceOptions {
    std::filesystem::path out;
    /// The command line after "run", and the folder in which it was given. The map keeps both.
    std::vector<std::string> arguments;
    std::filesystem::path started_in;
    bool tiles = false;                ///< writes tiles/, too
    SceneFileOptions files{};          ///< of scene.glb and tiles/, except `texture`
    bool texture = true;               ///< scene.glb has a texture
    double texel_m = 0;                ///< edge of its texels; 0: as fine as the pictures, from 0.5 to 2 mm
    uint32_t dump_every = 0;           ///< writes frames/NNNNNN.exr of every N-th frame; 0: none
    std::filesystem::path dump_graph;  ///< writes PATH.dot and PATH.json of the last frame's last graph; empty: none
};

/// Accompanies a run from its device to its summary: a live source, a window.
class RunCompanion {
  public:
    virtual ~RunCompanion() = default;

    /// Adds what the device has to have for it.
    virtual void prepare(vulkan::DeviceOptions&) {}
    /// The source; called once. Null: that of the options. `device` outlives it.
    virtual std::unique_ptr<Source> source(vulkan::Device& device) = 0;
    /// Changes the session's callbacks before it begins.
    virtual void adjust(SessionCallbacks& callbacks) = 0;
    /// After each step of the session.
    virtual void after_step(SessionCore& session) = 0;
    /// After the last frame, or after a failure; may be called again.
    virtual void end() = 0;
    /// What the source or its recording fell short of, one sentence each.
    virtual std::vector<std::string> shortfalls() const = 0;
    virtual void add_to(RunSummary& summary) const = 0;
    /// What a user is shown of it while it goes along: what, and how it is now.
    virtual std::vector<std::pair<std::string, std::string>> figures() const { return {}; }
};

/// Reconstructs a sequence and writes the run's folder, whole (OutputFolder). If the user or an error stops the run, it
/// writes what was fused so far, and run.json has the reason; if the device was lost, it writes what the host has. Such
/// results never replace whole ones (OutputFolder::commit_unfinished). Returns what the results fall short of. Throws
/// Error with the reason that stopped the run, Interrupted if the user stopped it before a frame was fused.
/// `companion` may be null; it outlives the run.
Outcome run(const RunOptions& options, RunCompanion* companion = nullptr);

}  // namespace patina::tools
