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
    /// The command line after "run", and the folder it was given in: they are kept in the map.
    std::vector<std::string> arguments;
    std::filesystem::path started_in;
    bool tiles = false;        ///< writes tiles/, too
    SceneFileOptions files{};  ///< of scene.glb and tiles/; but for `texture`
    bool texture = true;       ///< scene.glb has one
    double texel_m = 0;        ///< its texels' edge; 0: as fine as the pictures, from 0.5 to 2 mm
    uint32_t dump_every = 0;   ///< frames/NNNNNN.exr of every so many frames; 0 writes none
    std::filesystem::path
        dump_graph;  ///< writes PATH.dot and PATH.json of the last frame's last graph; empty writes none
};

/// Who goes along with a run from its device to its summary: a live source, a window.
class RunCompanion {
  public:
    virtual ~RunCompanion() = default;

    /// Adds what the device has to have for it.
    virtual void prepare(vulkan::DeviceOptions&) {}
    /// The source; called once. Null: that of the options. `device` outlives it.
    virtual std::unique_ptr<Source> source(vulkan::Device& device) = 0;
    /// Changes what the session calls while it works.
    virtual void adjust(SessionCallbacks& callbacks) = 0;
    /// After each step of the session.
    virtual void after_step(SessionCore& session) = 0;
    /// Once the last frame was taken, or something failed; may be called again.
    virtual void end() = 0;
    /// What it fell short of.
    virtual std::vector<std::string> shortfalls() const = 0;
    virtual void add_to(RunSummary& summary) const = 0;
    /// What a user is shown of it while it goes along: what, and how it is now.
    virtual std::vector<std::pair<std::string, std::string>> figures() const { return {}; }
};

/// Reconstructs a sequence and writes the run's folder, whole (OutputFolder). When the user stops it, or an error does,
/// what was fused so far is extracted and written, and run.json says how the run ended; of a device that was lost, what
/// the host has. Such results take the place of no whole ones (OutputFolder::commit_unfinished). Returns what the
/// results fall short of. Throws Error for whatever stopped the run, Interrupted when the user did before a frame was
/// fused.
/// `companion` may be null; it must outlive the run.
Outcome run(const RunOptions& options, RunCompanion* companion = nullptr);

}  // namespace patina::tools
