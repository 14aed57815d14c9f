#include "scenes/files/readers/include.h"

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scenes/files/readers/objects.h"
#include "scenes/files/readers/values.h"

namespace patina::scenes {
namespace {

/// `lit`: the lamps that are on, by their places in the scene's list.
void keep_lights(const sensor::JsonValue& lit, SyntheticScene& scene) {
    std::vector<Light> kept;
    for (const sensor::JsonValue& index : lit.elements()) {
        const uint64_t at = index.whole_number(UINT16_MAX);
        if (at >= scene.lights.size())
            index.fail("but " + scene.name + " has " + std::to_string(scene.lights.size()) + " lamps");
        kept.push_back(scene.lights[at]);
    }
    scene.lights = std::move(kept);
}

void add_copy(const SyntheticScene& part, const RigidTransform& world_from_part, const std::string& name,
              SyntheticScene& scene) {
    for (SceneObject object : part.objects) {
        object.material.name = name + ": " + object.material.name;
        for (Part& each : object.parts) each.world_from_part = world_from_part * each.world_from_part;
        scene.objects.push_back(std::move(object));
    }
    for (Light light : part.lights) {
        light = moved(light, world_from_part);
        scene.lights.push_back(light);
    }
}

}  // namespace

void add_included(const sensor::JsonValue& include,
                  const std::function<SyntheticScene(const std::filesystem::path&)>& read, SyntheticScene& scene) {
    std::set<std::string> names;
    for (const sensor::JsonValue& element : include.elements()) {
        element.expect_keys({"scene", "without", "lights", "places"});
        const sensor::JsonValue file = element.at("scene");
        SyntheticScene part = located(file, [&] { return read(beside_file(file)); });
        if (const auto without = element.find("without")) remove_objects(*without, part);
        if (const auto lit = element.find("lights")) keep_lights(*lit, part);
        for (const sensor::JsonValue& place : element.at("places").elements()) {
            place.expect_keys({"name", "position", "rotations"});
            const std::string name = place.at("name").string();
            if (!names.insert(name).second) place.at("name").fail("which is the name of another place");
            add_copy(part, read_placement(place), name, scene);
        }
    }
    number_objects(include, scene);
}

}  // namespace patina::scenes
