#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "engine/vulkan/device.h"
#include "passes/reconstruction.h"

namespace patina::tools {

/// Whether each frame's colours are brought to the first one's exposure and white balance.
enum class GainMode {
    kAuto,  ///< where the recording does not tell the exposure
    kOn,
    kOff
};

/// What `patina run` was asked to do.
struct RunOptions {
    std::string sequence;  ///< folder of a recording, or "synthetic:SCENE"
    std::string format;    ///< of the recording; empty: recognised
    std::filesystem::path out;
    uint32_t frames = 0;      ///< at most so many frames of the sequence; 0 takes all (120 of a synthetic scene)
    uint32_t dump_every = 0;  ///< frames/NNNNNN.exr of every so many frames; 0 writes none
    uint64_t seed = 0;        ///< of everything that is drawn at random
    bool quiet = false;
    std::filesystem::path lights;  ///< lights.json: with it the run estimates reflectance too
    std::string lighting;          ///< or a sequence as find_lights takes it, in whose low-exposure frames they are
    uint32_t hold_out = 0;         ///< every so many-th picture is kept out of the model and compared in the end
    GainMode gains = GainMode::kAuto;
    bool truth_labels = false;         ///< segments are the objects of the sequence's truth/labels
    bool truth_materials = false;      ///< ks and alpha are those of truth/materials.json, by label
    std::filesystem::path dump_graph;  ///< writes PATH.dot and PATH.json of the last fused frame; empty writes none
    vulkan::DeviceOptions device;
    ReconstructionSettings settings;
};

/// Reconstructs a sequence and writes the run's folder; run.json comes last. Throws Error for whatever stops the run,
/// Interrupted when the user does; what was complete in the folder stays.
void run(const RunOptions& options);

}  // namespace patina::tools
