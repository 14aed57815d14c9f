#pragma once

#include <cstdint>
#include <filesystem>

#include "engine/vulkan/device.h"
#include "passes/state/network.h"

namespace patina::tools {

/// What `patina synth-hemi` was asked to do.
struct SynthHemiOptions {
    uint64_t seed = 1;
    uint32_t examples = 4096;
    std::filesystem::path out;
    HemisphereMap map = HemisphereMap::kParabolic;
    bool quiet = false;
};

/// Writes a file of labelled HemiImages (docs/guide/training.md); a seed gives the same file on one device. It appears
/// whole or not at all. Throws Error when it exists or cannot be written; Interrupted when the user stops it.
void synthesise_hemi_images(vulkan::Device& device, const SynthHemiOptions& options);

}  // namespace patina::tools
