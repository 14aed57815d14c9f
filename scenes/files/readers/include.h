#pragma once

#include <filesystem>
#include <functional>

#include "scenes/description/scene.h"
#include "sensor/files/json_file.h"

namespace patina::scenes {

/// Adds copies of other scenes' objects and lamps, each where the member "include" places it. `read` reads such a
/// scene. An object's name gets that of its place in front, as in "kitchen: table"; its id is its number in the scene.
/// Throws Error for what the other scene does not have, and for names that come twice.
void add_included(const sensor::JsonValue& include,
                  const std::function<SyntheticScene(const std::filesystem::path&)>& read, SyntheticScene& scene);

}  // namespace patina::scenes
