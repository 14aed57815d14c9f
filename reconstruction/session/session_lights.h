#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "reconstruction/session/find_lights.h"

namespace patina {

/// Lights and ambient term of a lights.json, in a world moved by `world_offset_m`. Throws Error as sensor::read_lights
/// does.
Illumination illumination_from_file(const std::filesystem::path& file, glm::dvec3 world_offset_m = glm::dvec3(0));

/// The same of lights in the recording's world.
Illumination illumination_of(const Lighting& lighting, glm::dvec3 world_offset_m);

/// The light of a session, and what about it is not as asked for.
struct SessionLight {
    Illumination illumination;
    std::string none_because;             ///< why there is no light, and what to give; empty where there is some
    std::vector<std::string> shortfalls;  ///< how a search that was asked for, or begun, failed
};

/// Where a session's lights come from.
enum class LightsSource {
    kNone,              ///< nowhere: geometry alone is reconstructed
    kGiven,             ///< the options hold them, or name their file
    kLightingSequence,  ///< the sequence that the user names, or the one that the main sequence has
    kMainSequence,      ///< what they light there
    kSurroundings       ///< no lamp is known at first: what surfaces send each other, and how bright pictures are; the
                        ///< session looks for lamps (SessionCore::look_for_light)
};

/// Where the options and the sequence say that lights come from; no light has been looked for. Throws Error where a
/// synthetic scene cannot be loaded.
LightsSource lights_source(const SessionOptions& options);

/// The lights of a session: those that the options hold, or found where they say, or in the lighting sequence that the
/// main sequence has. Without that, the light of the surroundings (surroundings.h). Where a lighting sequence shows no
/// lamp, what else it shows is the light (tells_surroundings()), beside which a session looks for more; where it does
/// not tell that, lights are looked for in what they light in the main sequence, and where there is no lamp either, the
/// ambient light stands alone. A search that fails costs the light, not the run. Throws Error when the file that is
/// given cannot be read, or the sequence that is named cannot be opened; Interrupted when the user stops it.
SessionLight light_of(vulkan::Device& device, const SessionOptions& options, glm::dvec3 world_offset_m);

/// Shows a pipeline what the session's lighting sequence shows, where that is where its lights come from
/// (Pipeline::add_low_exposure). What goes wrong is left out. Throws Interrupted when the user stops it.
void add_low_exposure(vulkan::Device& device, Pipeline& pipeline, const SessionOptions& options,
                      glm::dvec3 world_offset_m);

/// For run.json: the lights, how they were found, and how sure that is.
nlohmann::ordered_json lights_json(const Illumination& illumination);

}  // namespace patina
