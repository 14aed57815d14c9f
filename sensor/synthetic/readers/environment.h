#pragma once

#include "sensor/json_file.h"
#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// Reads the member "environment" of a scene file: an HDR file, or one that is drawn.
Environment read_environment(const JsonValue& value);

}  // namespace patina::sensor
