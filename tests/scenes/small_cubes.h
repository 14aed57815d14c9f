#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

namespace patina::testing {

/// Writes the built-in cubes for a camera of 256 x 212, a quarter of the pixels. Returns `synthetic:FILE`. Who includes
/// this defines PATINA_SOURCE_DIR.
inline std::string small_cubes(const std::filesystem::path& file) {
    std::ifstream built_in(PATINA_SOURCE_DIR "/assets/scenes/cubes.json");
    nlohmann::json scene = nlohmann::json::parse(built_in);
    scene["camera"] = {{"width", 256}, {"height", 212}, {"fx", 182.5}, {"fy", 182.5}, {"cx", 127.5}, {"cy", 105.5}};
    std::ofstream(file) << scene.dump();
    return "synthetic:" + file.string();
}

}  // namespace patina::testing
