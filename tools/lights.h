#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/vulkan/device.h"
#include "passes/light_estimation.h"

namespace patina::tools {

/// What `patina lights` was asked to do.
struct LightsOptions {
    std::string sequence;  ///< folder of a recording with lighting/, or of a lighting sequence; or "synthetic:SCENE"
    std::filesystem::path out;  ///< lights.json; empty: written nowhere
    uint32_t frames = 0;        ///< at most so many frames of the lighting sequence; 0 takes all
    bool quiet = false;
    vulkan::DeviceOptions device;
    LightEstimationSettings settings;
};

/// Finds the lamps in a sequence of low exposure (paper, Section 3.2), in the world and in the pixel values of the
/// reflectance sequence beside it: the folder that holds lighting/. A sequence that is in no such folder is taken by
/// itself: intensities are then in its own pixel values. Writes lights.json, whole or not at all. Throws Error when
/// there is no lighting sequence, it has no poses, or a file cannot be read or written; Interrupted when the user stops
/// it.
std::vector<FoundLight> find_lights(const LightsOptions& options);

}  // namespace patina::tools
