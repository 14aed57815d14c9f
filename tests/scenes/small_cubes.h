#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <nlohmann/json.hpp>

namespace patina::testing {

/// Writes the built-in cubes for a camera of 256 x 212, a quarter of the pixels, or of `scale` times that. Returns
/// `synthetic:FILE`. Who includes this defines PATINA_SOURCE_DIR.
inline std::string small_cubes(const std::filesystem::path& file, double scale = 1) {
    std::ifstream built_in(PATINA_SOURCE_DIR "/assets/scenes/cubes.json");
    nlohmann::json scene = nlohmann::json::parse(built_in);
    scene["camera"] = {{"width", std::lround(256 * scale)},
                       {"height", std::lround(212 * scale)},
                       {"fx", 182.5 * scale},
                       {"fy", 182.5 * scale},
                       {"cx", 128 * scale - 0.5},
                       {"cy", 106 * scale - 0.5}};
    std::ofstream(file) << scene.dump();
    return "synthetic:" + file.string();
}

}  // namespace patina::testing
