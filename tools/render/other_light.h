#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "patina/image.h"
#include "patina/lighting.h"
#include "reconstruction/session/session_core.h"
#include "reconstruction/stages/reflectance_stage.h"

namespace patina::tools {

/// Light that views are shown under in place of the reconstruction's: lamps, an environment, or both.
struct OtherLight {
    Lighting lighting;                            ///< in the recording's world
    std::optional<Image<glm::vec3>> environment;  ///< a latitude-longitude picture: lights/split_environment.h
    double turn_deg = 0;                          ///< of the environment about up, seen from above: anticlockwise
};

/// Reads it: a .hdr or .exr file is an environment, any other a lights.json. Throws Error where a file cannot be read,
/// for more than one environment, for more lamps than a view can have, or for a turn of no environment.
OtherLight read_other_light(std::span<const std::filesystem::path> files, double turn_deg);

/// The same for a session that has come to its end. Its environment stands as upright as a scene.glb of the session
/// would.
Relighting relighting_of(const OtherLight& light, SessionCore& session);

}  // namespace patina::tools
