#pragma once

#include "scenes/description/scene.h"
#include "sensor/files/json_file.h"

namespace patina::scenes {

/// Reads how a scene is looked at into it: the members "fps", "camera", "color_camera", "depth", "path" and "lighting"
/// of a scene file. Throws Error for a path whose optical axis comes within one degree of the vertical.
void read_cameras(const sensor::JsonValue& root, SyntheticScene& scene);

}  // namespace patina::scenes
