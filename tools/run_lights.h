#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "passes/model/lights.h"
#include "tools/lights.h"
#include "tools/sequence_fusion.h"

namespace patina::tools {

/// Lights and ambient term of a lights.json, in a world moved by `world_offset_m`. Throws Error as sensor::read_lights
/// does.
Illumination illumination_from_file(const std::filesystem::path& file, glm::dvec3 world_offset_m = glm::dvec3(0));

/// The light of a run, and what about it is not as asked for.
struct LightOfRun {
    Illumination illumination;
    std::string none_because;             ///< why there is no light, and what to give; empty where there is some
    std::vector<std::string> shortfalls;  ///< how a search that was asked for, or begun, failed
};

/// Where a run's lights come from.
enum class LightsSource {
    kNone,              ///< nowhere: geometry alone is reconstructed
    kFile,              ///< SequenceOptions::lights
    kLightingSequence,  ///< the sequence that the user names, or the one that the main sequence has
    kMainSequence       ///< what they light there
};

/// Where the options and the sequence say that lights come from; no light has been looked for. Throws Error where a
/// synthetic scene cannot be loaded.
LightsSource lights_source(const SequenceOptions& options);

/// The lights of a run: those of the file that the user gives, those found where the user says, or in the lighting
/// sequence that the main sequence has. Where a lighting sequence shows no lamp, lights are looked for in what they
/// light in the main sequence; where there is no lamp either, the ambient light stands alone. A search that fails costs
/// the light, not the run. Throws Error when the file that is given cannot be read, or the sequence that is named
/// cannot be opened; Interrupted when the user stops it.
LightOfRun light_of(const SequenceOptions& options, glm::dvec3 world_offset_m);

std::vector<PointLight> point_lights(const Illumination& illumination);

/// For run.json: the lights, how they were found, and how sure that is.
nlohmann::ordered_json lights_json(const Illumination& illumination);

}  // namespace patina::tools
