#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "scenes/description/scene.h"

namespace patina::scenes {

/// What changes a scene as it is loaded.
struct SceneChanges {
    std::filesystem::path mesh{};    ///< takes the place of every mesh whose height the scene file sets; empty: none
    std::optional<uint64_t> vary{};  ///< seed for other materials, lights and path of the same kind
    std::optional<uint64_t> seed{};  ///< of noise and random samples, instead of the recording's
};

/// Loads a scene: a JSON file, or the name of a built-in one (see scene_names). Throws Error, one sentence with file,
/// path in the JSON and value, for whatever is wrong in the file or in what it names.
SyntheticScene load_scene(const std::string& name_or_file, const SceneChanges& changes = {});

/// SCENE of "synthetic:SCENE", as programs take a scene in a sequence's place; empty for the path of a recording.
std::optional<std::string> scene_name(const std::string& sequence);

/// What ships with the source: assets/, or where the environment's PATINA_ASSETS says.
std::filesystem::path assets_folder();

/// The names of the built-in scenes, as "balls, bunnies, cubes, halls, office".
std::string scene_names();

}  // namespace patina::scenes
