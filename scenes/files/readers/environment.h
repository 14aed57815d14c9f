#pragma once

#include "scenes/description/scene.h"
#include "sensor/files/json_file.h"

namespace patina::scenes {

/// Reads the member "environment" of a scene file: an HDR file, or one that is drawn.
Environment read_environment(const sensor::JsonValue& value);

}  // namespace patina::scenes
