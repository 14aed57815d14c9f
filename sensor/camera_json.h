#pragma once

#include <nlohmann/json.hpp>

#include "patina/camera.h"

namespace patina::sensor {

/// A camera as sequence.json and run.json have it.
nlohmann::ordered_json camera_json(const Intrinsics& camera);

}  // namespace patina::sensor
