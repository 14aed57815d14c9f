#include "sensor/truth.h"

#include <nlohmann/json.hpp>

#include "sensor/text_file.h"

namespace patina::sensor {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(glm::dvec3 v) { return Json::array({v.x, v.y, v.z}); }

}  // namespace

void write_lights(const std::filesystem::path& file, std::span<const PointLight> lights) {
    Json list = Json::array();
    for (const PointLight& light : lights) {
        list.push_back({{"position", to_json(light.position_m)}, {"intensity", to_json(light.intensity)}});
    }
    write_bytes(file, Json{{"lights", list}}.dump(2) + "\n");
}

void write_materials(const std::filesystem::path& file, std::span<const Material> materials) {
    Json list = Json::array();
    for (const Material& material : materials) {
        list.push_back({{"id", material.id},
                        {"name", material.name},
                        {"kd", material.kd ? to_json(*material.kd) : Json("texture")},
                        {"ks", to_json(material.ks)},
                        {"alpha", material.alpha}});
    }
    write_bytes(file, Json{{"materials", list}}.dump(2) + "\n");
}

}  // namespace patina::sensor
