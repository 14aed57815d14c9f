#pragma once

#include "scenes/description/scene.h"
#include "sensor/files/json_file.h"

namespace patina::scenes {

/// Reads one of a scene file's textures: a picture file or a pattern, what a repeat of it spans, and where in (u, v)
/// its top left corner lies.
Texture read_texture(const sensor::JsonValue& value);

}  // namespace patina::scenes
