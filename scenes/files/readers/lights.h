#pragma once

#include <vector>

#include "scenes/description/scene.h"
#include "sensor/files/json_file.h"

namespace patina::scenes {

/// Reads the member "lights" of a scene file.
std::vector<Light> read_lights(const sensor::JsonValue& value);

}  // namespace patina::scenes
