#include "sensor/synthetic/scene_file.h"

#include "engine/core/error.h"
#include "sensor/synthetic/cubes.h"

namespace patina::sensor {

Scene load_scene(const std::string& name_or_file, const SceneChanges&) {
    if (name_or_file == "cubes") return make_cubes();
    throw Error("there is no built-in scene '", name_or_file, "'; there is: ", scene_names());
}

std::string scene_names() { return "cubes"; }

}  // namespace patina::sensor
