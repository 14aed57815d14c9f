#pragma once

#include <filesystem>
#include <vector>

#include "scenes/description/scene.h"
#include "scenes/files/readers/materials.h"
#include "sensor/files/json_file.h"

namespace patina::scenes {

/// Reads the member "objects" of a scene file; ids count from 1 in their order. `mesh`, unless empty, takes the place
/// of every mesh file that is scaled to a height.
std::vector<SceneObject> read_objects(const sensor::JsonValue& value, const MaterialReader& materials,
                                      const std::filesystem::path& mesh);

}  // namespace patina::scenes
