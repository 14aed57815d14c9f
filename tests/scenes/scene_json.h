#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "scenes/files/scene_file.h"

namespace patina::scenes::testing {

/// A small valid scene with every kind of member that needs no other file.
nlohmann::json small_scene();

/// Writes a scene to `file` and loads it.
SyntheticScene load(const std::filesystem::path& file, const nlohmann::json& scene, const SceneChanges& changes = {});

/// What loading it throws; "no error" if nothing.
std::string load_error(const std::filesystem::path& file, const std::string& content, const SceneChanges& changes = {});

}  // namespace patina::scenes::testing
