#pragma once

#include "sensor/json_file.h"
#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// Reads how a scene is looked at into it: the members "fps", "camera", "color_camera", "depth", "path" and "lighting"
/// of a scene file. Throws Error for a path whose optical axis comes within one degree of the vertical.
void read_cameras(const JsonValue& root, Scene& scene);

}  // namespace patina::sensor
