#pragma once

#include <nlohmann/json.hpp>

#include "patina/camera.h"
#include "sensor/files/json_file.h"

namespace patina::sensor {

/// A camera as sequence.json and run.json have it.
nlohmann::ordered_json camera_json(const Intrinsics& camera);

/// The same, read. Throws Error when a member is missing, or a value is outside what it may be.
Intrinsics read_camera(const JsonValue& camera);

/// Three numbers. Throws Error when they are no numbers, or all 0.
glm::dvec3 read_direction(const JsonValue& value);

}  // namespace patina::sensor
