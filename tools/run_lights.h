#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "passes/model/lights.h"
#include "tools/lights.h"
#include "tools/sequence_fusion.h"

namespace patina::tools {

/// Lights and ambient term of a lights.json. Throws Error as sensor::read_lights does.
Illumination illumination_from_file(const std::filesystem::path& file);

/// The lights of a run: those of the file that the user gives, those found where the user says, or in the lighting
/// sequence that the main sequence has; none where there is none of these. Throws Error as find_lights does, and when
/// none is found where the user says.
Illumination lights_of(const SequenceOptions& options);

std::vector<PointLight> point_lights(const Illumination& illumination);

/// For run.json: the lights, how they were found, and how sure that is.
nlohmann::ordered_json lights_json(const Illumination& illumination);

}  // namespace patina::tools
