#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace patina::testing {

/// What a finished run is remembered by, as numbers that every driver reproduces within tolerances: "surface" (counts,
/// area and bounds of scene.glb), "materials" (of the segments with 100 observations or more, by id), "lights", and
/// "view" (frames/FRAME.exr: over all, and means over the pixels of each cell of a 4 x 3 grid that show the surface).
/// Metres, pixel values linear. Throws Error or nlohmann::json::exception where a file is missing or damaged.
nlohmann::json golden_numbers(const std::filesystem::path& run_folder, const std::string& frame);

/// How far the number at `path`, as "/view/cells/3/depth_m", may be from the stored one. Throws std::out_of_range for a
/// name that golden_numbers() does not use.
double golden_tolerance(const std::string& path, double stored);

/// One sentence for each number that is missing, new, or out of its tolerance.
std::vector<std::string> golden_differences(const nlohmann::json& stored, const nlohmann::json& measured);

}  // namespace patina::testing
