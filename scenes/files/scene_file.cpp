#include "scenes/files/scene_file.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include <dlfcn.h>

#include "engine/core/did_you_mean.h"
#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "scenes/description/vary.h"
#include "scenes/files/readers/camera.h"
#include "scenes/files/readers/environment.h"
#include "scenes/files/readers/include.h"
#include "scenes/files/readers/lights.h"
#include "scenes/files/readers/materials.h"
#include "scenes/files/readers/objects.h"
#include "scenes/files/readers/recording.h"
#include "scenes/files/readers/values.h"
#include "sensor/files/json_file.h"

namespace patina::scenes {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".json";

/// The program or library that this code is in; empty where that is not known.
fs::path this_binary() {
    Dl_info info{};
    std::error_code none;
    if (dladdr(reinterpret_cast<void*>(&assets_folder), &info) != 0 && info.dli_fname) {
        const fs::path file = fs::canonical(info.dli_fname, none);
        if (!none && file.extension() != "") return file;  // a library; a program's name may be relative
    }
    return fs::read_symlink("/proc/self/exe", none);
}

fs::path scenes_folder() { return assets_folder() / "scenes"; }

/// In alphabetical order.
std::vector<std::string> built_in_scenes() {
    std::vector<std::string> names;
    std::error_code ignored;  // a folder that is missing has no scenes
    for (const auto& entry : fs::directory_iterator(scenes_folder(), ignored))
        if (entry.path().extension() == kExtension) names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

fs::path file_of(const std::string& name_or_file) {
    if (name_or_file.find('/') != std::string::npos || name_or_file.ends_with(kExtension)) return name_or_file;
    const fs::path file = scenes_folder() / (name_or_file + kExtension);
    if (!path_exists(file)) {
        const std::vector<std::string> names = built_in_scenes();
        const std::string meant = did_you_mean(name_or_file, names);
        throw Error("there is no built-in scene '", name_or_file, "' in ", scenes_folder().string(),
                    meant.empty() ? "; there is: " + scene_names() : meant);
    }
    return file;
}

/// The scene that a scene changes, in the same folder, so that the files it names are found.
sensor::JsonValue read_base(const sensor::JsonValue& name) {
    if (fs::path(name.string()).has_parent_path()) name.fail("must be a file beside it");
    sensor::JsonValue base = located(name, [&] { return sensor::JsonValue::read(beside_file(name)); });
    if (base.find("base")) name.fail("which has a base itself");
    return base;
}

Bumps read_bumps(const sensor::JsonValue& value) {
    value.expect_keys({"depth", "size", "seed"});
    Bumps bumps;
    bumps.depth_m = read_positive(value.at("depth"));
    bumps.size_m = read_positive(value.at("size"));
    if (const auto seed = value.find("seed")) bumps.seed = seed->whole_number(UINT64_MAX);
    return bumps;
}

/// `included`: within another scene, which takes its objects and lamps.
SyntheticScene read_scene(const fs::path& file, const fs::path& mesh, bool included = false) {
    const sensor::JsonValue own = sensor::JsonValue::read(file);
    const auto base_name = own.find("base");
    const std::optional<sensor::JsonValue> base = base_name ? std::optional(read_base(*base_name)) : std::nullopt;
    const sensor::JsonValue root = base ? base->patched(own) : own;
    root.expect_keys({"name", "base", "without", "fps", "camera", "color_camera", "depth", "textures", "materials",
                      "objects", "bumps", "include", "lights", "environment", "path", "lighting", "recording"});
    SyntheticScene scene;
    scene.name = own.find("name") ? own.at("name").string() : file.stem().string();
    std::vector<sensor::JsonValue> objects;
    if (base) objects.push_back(base->at("objects"));
    if (!base || own.find("objects")) objects.push_back(own.at("objects"));
    const auto bumps = root.find("bumps");
    scene.objects =
        read_objects(objects, MaterialReader(root), {mesh, bumps ? std::optional(read_bumps(*bumps)) : std::nullopt});
    if (const auto without = root.find("without")) remove_objects(*without, scene);
    if (const auto lights = root.find("lights")) scene.lights = read_lights(*lights);
    if (const auto include = root.find("include")) {
        if (included) include->fail("but this scene is included itself");
        add_included(
            *include, [&](const fs::path& other) { return read_scene(other, mesh, true); }, scene);
    }
    if (const auto environment = root.find("environment")) scene.environment = read_environment(*environment);
    read_cameras(root, scene);
    if (const auto recording = root.find("recording")) scene.recording = read_recording(*recording);
    return scene;
}

}  // namespace

SyntheticScene load_scene(const std::string& name_or_file, const SceneChanges& changes) {
    if (!changes.mesh.empty()) expect_file(changes.mesh);
    SyntheticScene scene = read_scene(file_of(name_or_file), changes.mesh);
    if (changes.seed) scene.recording.seed = scene.recording.render.seed = *changes.seed;
    return changes.vary ? varied(std::move(scene), *changes.vary) : scene;
}

std::optional<std::string> scene_name(const std::string& sequence) {
    constexpr std::string_view kSynthetic = "synthetic:";
    if (!sequence.starts_with(kSynthetic)) return std::nullopt;
    return sequence.substr(kSynthetic.size());
}

std::filesystem::path assets_folder() {
    const char* assets = std::getenv("PATINA_ASSETS");
    if (assets) return assets;
    const fs::path installed = this_binary().parent_path().parent_path() / "share/patina/assets";
    std::error_code none;
    return fs::is_directory(installed, none) ? installed : fs::path(PATINA_ASSETS_FOLDER);
}

std::string scene_names() {
    std::string list;
    for (const std::string& name : built_in_scenes()) list += (list.empty() ? "" : ", ") + name;
    return list;
}

}  // namespace patina::scenes
