#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/vulkan/device.h"
#include "patina/session.h"
#include "reconstruction/lights/light_estimation.h"
#include "reconstruction/lights/light_fitting.h"

namespace patina {

/// In what lights are looked for.
enum class LightsFrom : uint8_t {
    kAny,               ///< the lighting sequence where there is one, else the main sequence
    kLightingSequence,  ///< frames of low exposure, in which lamps are seen (paper, Section 3.2)
    kMainSequence,      ///< what the lamps light: see fit_lights
};

/// How lights are looked for.
struct LightsOptions {
    /// Folder of a recording with or without lighting/, or of a lighting sequence; or "synthetic:SCENE".
    std::string sequence;
    std::string format;   ///< of the main sequence; empty: recognised
    uint32_t frames = 0;  ///< at most so many frames of the sequence looked at; 0 takes all
    LightsFrom from = LightsFrom::kAny;
    /// In whose world the lamps are wanted where a lighting sequence of another folder has no poses: the main sequence;
    /// empty: the one that holds the lighting sequence.
    std::string main;
    std::string main_format;   ///< empty: recognised
    uint32_t main_frames = 0;  ///< as `frames`, of the main sequence, when a lighting sequence is found in its room
    uint32_t hold_out = 0;     ///< every so many-th frame of the main sequence is left aside (is_held_out); 0: none
    bool track = false;        ///< poses of the main sequence are tracked though it has some
    std::optional<uint64_t> seed{};  ///< of a synthetic scene's noise and samples; empty: what the scene says
    LightEstimationSettings settings;
    LightFittingSettings fitting;
    ReconstructionSettings reconstruction;  ///< of the main sequence's surface
    /// What is taken from all positions while lights are found (sensor::world_offset_m); empty: as the poses of the
    /// main sequence ask for.
    std::optional<glm::dvec3> world_offset_m;
    SessionCallbacks callbacks;
};

/// The lights of a room, and how they were found.
struct Illumination {
    std::string found_by = "none";   ///< "file", "lighting sequence", "main sequence", "surroundings", "none"
    std::vector<FoundLight> lights;  ///< brightest first; positions less world_offset_m
    glm::dvec3 world_offset_m{0};
    glm::dvec3 ambient{0};  ///< irradiance over pi that every surface receives, linear pixel value
    float misfit = 0;       ///< of the main sequence's surface: FittedLights
    float unexplained = 0;
    std::vector<glm::vec3> candidates_m{};  ///< where searches found lamps that no picture shows
    glm::dvec3 assumed{0};                  ///< `ambient` before anything told it, where no lamp is known at first
    bool given = false;                     ///< by the caller, who knows all lamps, however they were found
};

/// Whether there may be other lamps than these: a lighting sequence tells those that it shows, if any; without one
/// nothing told any.
bool may_lack_lamps(const Illumination& illumination);

/// Whether anything receives light.
bool shines(const Illumination& illumination);

/// Where a light is in the recording's world.
glm::dvec3 world_position_m(const Illumination& illumination, const Light& light);

/// The lights in the recording's world, as files hold them.
Lighting lighting_of(const Illumination& illumination);

/// The lights where the reconstruction has them.
std::vector<Light> lights_of(const Illumination& illumination);

/// Whether a sequence has a lighting sequence of its own: the folder lighting/, or a scene's.
bool has_lighting_sequence(const std::string& sequence);

/// Finds the lamps of a room. In a sequence of low exposure (paper, Section 3.2): in the world and in the pixel values
/// of the reflectance sequence beside it, the folder that holds lighting/; of one in no such folder (kLightingSequence
/// alone) intensities are in its own pixel values. One without poses is brought into the main sequence's world
/// (localise.h). In the main sequence: as fit_lights says. Throws Error when a sequence has no poses and there is no
/// main one, or a file cannot be read; Interrupted when the caller stops it.
Illumination find_lights(vulkan::Device& device, const LightsOptions& options);

/// Whether a recorded lighting sequence tells what is around the main sequence: that is known, its surfaces light each
/// other and the reconstruction gathers that light, and both have poses in the same world. Throws Error when a file
/// cannot be read.
bool tells_surroundings(vulkan::Device& device, const LightsOptions& options);

/// Calls take(frame, radiance_scale) for every frame of a recorded lighting sequence that has a pose in the main
/// sequence's world; the scale is the main sequence's exposure over the frame's. For none where that world is another,
/// or the main sequence is not known. Throws Error when a file cannot be read; Interrupted when the caller stops it.
using TakeLowExposure = std::function<void(const RgbdFrame& frame, float radiance_scale)>;
void for_each_low_exposure(vulkan::Device& device, const LightsOptions& options, const TakeLowExposure& take);

}  // namespace patina
