#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "engine/vulkan/device.h"

namespace patina::tools {

/// Records `frames` frames of a built-in scene as a sequence folder with truth/: lights.json, materials.json,
/// trajectory.txt and labels/NNNNNN.png. The folder appears whole or not at all. Throws Error when the scene is
/// unknown, `frames` is 0, or the folder exists and is not empty or cannot be written.
void synthesise(vulkan::Device& device, const std::string& scene, uint32_t frames, const std::filesystem::path& out);

}  // namespace patina::tools
