#pragma once

#include "sensor/json_file.h"
#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// Reads the member "environment" of a scene file: one of "uniform", "sky", "studio" or "file", and a "scale".
Environment read_environment(const JsonValue& value);

}  // namespace patina::sensor
