#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "passes/reconstruction.h"

namespace patina::tools {

/// Overrides settings from a TOML file, tables [map], [fusion], [input]. Throws Error naming the file, the key, and
/// what is wrong.
void load_settings(ReconstructionSettings& settings, const std::filesystem::path& file);

/// Overrides one setting from "fusion.max_depth_m=3". Throws Error naming the key or the value.
void apply_setting(ReconstructionSettings& settings, const std::string& assignment);

/// All settings by their keys, in a fixed order.
nlohmann::ordered_json settings_json(const ReconstructionSettings& settings);

}  // namespace patina::tools
