#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/vulkan/device.h"
#include "passes/light_estimation.h"
#include "passes/light_fitting.h"

namespace patina::tools {

/// In what lights are looked for.
enum class LightsFrom : uint8_t {
    kAny,               ///< the lighting sequence where there is one, else the main sequence
    kLightingSequence,  ///< frames of low exposure, in which lamps are seen (paper, Section 3.2)
    kMainSequence,      ///< what the lamps light: see fit_lights
};

/// What `patina lights` was asked to do.
struct LightsOptions {
    std::string sequence;       ///< folder of a recording with or without lighting/, or of a lighting sequence; or
                                ///< "synthetic:SCENE"
    std::string format;         ///< of the main sequence; empty: recognised
    std::filesystem::path out;  ///< lights.json; empty: written nowhere
    uint32_t frames = 0;        ///< at most so many frames of the sequence looked at; 0 takes all
    bool quiet = false;
    LightsFrom from = LightsFrom::kAny;
    /// In whose world the lamps are wanted where a lighting sequence of another folder has no poses: the main sequence;
    /// empty: the one that holds the lighting sequence.
    std::string main;
    std::string main_format;   ///< empty: recognised
    uint32_t main_frames = 0;  ///< as `frames`, of the main sequence, when a lighting sequence is found in its room
    bool track = false;        ///< poses of the main sequence are tracked though it has some
    std::optional<uint64_t> seed{};  ///< of a synthetic scene's noise and samples; empty: what the scene says
    vulkan::DeviceOptions device;
    LightEstimationSettings settings;
    LightFittingSettings fitting;
    ReconstructionSettings reconstruction;  ///< of the main sequence's surface
    /// What is taken from all positions while lights are found (sensor::world_offset_m); empty: as the poses of the
    /// main sequence ask for.
    std::optional<glm::dvec3> world_offset_m;
};

/// The lights of a room, and how they were found.
struct Illumination {
    std::string found_by = "none";   ///< "file", "lighting sequence", "main sequence", "none"
    std::vector<FoundLight> lights;  ///< brightest first; positions less world_offset_m
    glm::dvec3 world_offset_m{0};
    glm::vec3 ambient{0};  ///< irradiance over pi that every surface receives, linear pixel value
    float misfit = 0;      ///< of the main sequence's surface: FittedLights
    float unexplained = 0;
};

/// Whether anything receives light.
bool shines(const Illumination& illumination);

/// Where a light is in the recording's world.
glm::dvec3 world_position_m(const Illumination& illumination, const FoundLight& light);

/// Prints lamps and ambient light, a line each.
void print_lights(const Illumination& illumination);

/// Writes lights.json of the sequence format. Throws Error when the file cannot be written.
void write_lights_json(const std::filesystem::path& file, const Illumination& illumination);

/// Whether a sequence has a lighting sequence of its own: the folder lighting/, or a scene's.
bool has_lighting_sequence(const std::string& sequence);

/// Finds the lamps of a room. In a sequence of low exposure (paper, Section 3.2): in the world and in the pixel values
/// of the reflectance sequence beside it, the folder that holds lighting/; of one in no such folder (kLightingSequence
/// alone) intensities are in its own pixel values. One without poses is brought into the main sequence's world
/// (localise.h). In the main sequence: as fit_lights says. Writes lights.json, whole or not at all. Throws Error when a
/// sequence has no poses and there is no main one, or a file cannot be read or written; Interrupted when the user stops
/// it.
Illumination find_lights(const LightsOptions& options);

}  // namespace patina::tools
