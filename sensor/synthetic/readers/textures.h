#pragma once

#include "sensor/json_file.h"
#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// Reads one of a scene file's textures: a picture file or a pattern, what a repeat of it spans, and where in (u, v)
/// its top left corner lies.
Texture read_texture(const JsonValue& value);

}  // namespace patina::sensor
