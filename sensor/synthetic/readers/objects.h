#pragma once

#include <filesystem>
#include <vector>

#include "sensor/json_file.h"
#include "sensor/synthetic/readers/materials.h"
#include "sensor/synthetic/scene.h"

namespace patina::sensor {

/// Reads the member "objects" of a scene file; ids count from 1 in their order. `mesh`, unless empty, takes the place
/// of every mesh file that is scaled to a height.
std::vector<SceneObject> read_objects(const JsonValue& value, const MaterialReader& materials,
                                      const std::filesystem::path& mesh);

}  // namespace patina::sensor
