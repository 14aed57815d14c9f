#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "export/scene_files.h"
#include "tools/program/outcome.h"
#include "tools/program/sequence_options.h"

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

/// Reconstructs a sequence and writes the run's folder, whole (OutputFolder). When the user stops it, or an error does,
/// what was fused so far is extracted and written, and run.json says how the run ended; of a device that was lost, what
/// the host has. Such results take the place of no whole ones (OutputFolder::commit_unfinished). Returns what the
/// results fall short of. Throws Error for whatever stopped the run, Interrupted when the user did before a frame was
/// fused.
Outcome run(const RunOptions& options);

}  // namespace patina::tools
