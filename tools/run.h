#pragma once

#include <cstdint>
#include <filesystem>

#include "tools/sequence_fusion.h"

namespace patina::tools {

/// What `patina run` was asked to do.
struct RunOptions : SequenceOptions {
    std::filesystem::path out;
    uint32_t dump_every = 0;  ///< frames/NNNNNN.exr of every so many frames; 0 writes none
    uint64_t seed = 0;        ///< of everything that is drawn at random
    std::filesystem::path
        dump_graph;  ///< writes PATH.dot and PATH.json of the last frame's last graph; empty writes none
};

/// Reconstructs a sequence and writes the run's folder; run.json comes last. Throws Error for whatever stops the run,
/// Interrupted when the user does; what was complete in the folder stays.
void run(const RunOptions& options);

}  // namespace patina::tools
