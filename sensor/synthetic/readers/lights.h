#pragma once

#include <vector>

#include "sensor/json_file.h"
#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// Reads the member "lights" of a scene file.
std::vector<PointLight> read_lights(const JsonValue& value);

}  // namespace patina::sensor
