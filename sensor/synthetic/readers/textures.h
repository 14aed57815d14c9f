#pragma once

#include "sensor/json_file.h"
#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// Reads one of the textures of a scene file: a procedural pattern by its name or a picture file, how far one repeat
/// reaches, and where the picture's top left corner lies: "offset" in (u, v), rounded to whole texels.
Texture read_texture(const JsonValue& value);

}  // namespace patina::sensor
