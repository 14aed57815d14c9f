#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "scenes/description/bumps.h"
#include "scenes/description/scene.h"
#include "scenes/files/readers/materials.h"
#include "sensor/files/json_file.h"

namespace patina::scenes {

/// What changes meshes that are scaled to a height.
struct MeshChanges {
    std::filesystem::path file{};  ///< takes their place; empty: none does
    std::optional<Bumps> bumps{};
};

/// Reads members "objects" of scene files, one after the other; ids count from 1 in their order.
std::vector<SceneObject> read_objects(std::span<const sensor::JsonValue> lists, const MaterialReader& materials,
                                      const MeshChanges& changes);

/// Takes out the objects of these names, and counts ids anew. Throws Error for one that there is not.
void remove_objects(const sensor::JsonValue& names, SyntheticScene& scene);

/// Counts ids from 1 in the objects' order. Throws Error, about `value`, where label images cannot tell so many apart.
void number_objects(const sensor::JsonValue& value, SyntheticScene& scene);

}  // namespace patina::scenes
