#include "sensor/synthetic/scene_file.h"

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "sensor/json_file.h"
#include "sensor/synthetic/readers/camera.h"
#include "sensor/synthetic/readers/environment.h"
#include "sensor/synthetic/readers/lights.h"
#include "sensor/synthetic/readers/materials.h"
#include "sensor/synthetic/readers/objects.h"
#include "sensor/synthetic/readers/recording.h"
#include "sensor/synthetic/vary.h"

namespace patina::sensor {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".json";

fs::path scenes_folder() { return assets_folder() / "scenes"; }

fs::path file_of(const std::string& name_or_file) {
    if (name_or_file.find('/') != std::string::npos || name_or_file.ends_with(kExtension)) return name_or_file;
    const fs::path file = scenes_folder() / (name_or_file + kExtension);
    if (!fs::exists(file)) {
        throw Error("there is no built-in scene '", name_or_file, "' in ", scenes_folder().string(),
                    "; there is: ", scene_names());
    }
    return file;
}

Scene read_scene(const fs::path& file, const fs::path& mesh) {
    const JsonValue root = JsonValue::read(file);
    root.expect_keys({"name", "fps", "camera", "color_camera", "depth", "textures", "materials", "objects", "lights",
                      "environment", "path", "lighting", "recording"});
    Scene scene;
    scene.name = root.find("name") ? root.at("name").string() : file.stem().string();
    scene.objects = read_objects(root.at("objects"), MaterialReader(root), mesh);
    if (const auto lights = root.find("lights")) scene.lights = read_lights(*lights);
    if (const auto environment = root.find("environment")) scene.environment = read_environment(*environment);
    read_cameras(root, scene);
    if (const auto recording = root.find("recording")) scene.recording = read_recording(*recording);
    return scene;
}

}  // namespace

Scene load_scene(const std::string& name_or_file, const SceneChanges& changes) {
    Scene scene = read_scene(file_of(name_or_file), changes.mesh);
    return changes.vary ? varied(std::move(scene), *changes.vary) : scene;
}

std::filesystem::path assets_folder() {
    const char* assets = std::getenv("PATINA_ASSETS");
    return assets ? assets : PATINA_ASSETS_FOLDER;
}

std::string scene_names() {
    std::vector<std::string> names;
    std::error_code ignored;  // a folder that is missing has no scenes
    for (const auto& entry : fs::directory_iterator(scenes_folder(), ignored))
        if (entry.path().extension() == kExtension) names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

}  // namespace patina::sensor
