#pragma once

#include <vector>

#include "sensor/files/json_file.h"
#include "scenes/description/scene.h"

namespace patina::scenes {

/// Reads the member "lights" of a scene file.
std::vector<Light> read_lights(const sensor::JsonValue& value);

}  // namespace patina::scenes
