#include "sensor/truth.h"

#include <cstdint>
#include <set>

#include <nlohmann/json.hpp>

#include "engine/core/error.h"
#include "sensor/camera_json.h"
#include "sensor/files/json_file.h"
#include "sensor/files/text_file.h"

namespace patina::sensor {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMostLights = 4096;  // lamps are compared in pairs

Json to_json(glm::dvec3 v) { return Json::array({v.x, v.y, v.z}); }

glm::dvec3 read_vector(const JsonValue& value) {
    const std::vector<double> v = value.numbers(3);
    return {v[0], v[1], v[2]};
}

glm::dvec3 read_intensity(const JsonValue& value) {
    const glm::dvec3 intensity = read_vector(value);
    if (glm::any(glm::lessThan(intensity, glm::dvec3(0)))) value.fail("must not be negative");
    return intensity;
}

glm::dvec3 read_albedo(const JsonValue& value) {
    const glm::dvec3 albedo = read_vector(value);
    if (glm::clamp(albedo, 0.0, 1.0) != albedo) value.fail("must lie in 0 to 1");
    return albedo;
}

std::optional<glm::dvec3> read_kd(const JsonValue& value) {
    if (!value.is_string()) return read_albedo(value);
    if (value.string() != "texture") value.fail("must be three numbers or \"texture\"");
    return std::nullopt;
}

/// Label images have 16 bits, and 0 is the background.
uint32_t read_label(const JsonValue& value) {
    if (value.positive_integer() > UINT16_MAX) value.fail(text("must be at most ", UINT16_MAX));
    return value.positive_integer();
}

double read_alpha(const JsonValue& value) {
    const double alpha = value.number();
    if (!(alpha > 0 && alpha <= 1)) value.fail("must lie above 0 and up to 1");
    return alpha;
}

}  // namespace

void write_lights(const std::filesystem::path& file, std::span<const Light> lights, glm::dvec3 ambient,
                  std::span<const AreaLight> windows) {
    Json list = Json::array();
    for (const Light& light : lights) {
        Json entry{{"position", to_json(light.position_m)}, {"intensity", to_json(light.intensity)}};
        if (light.radius_m > 0) entry["radius"] = light.radius_m;
        if (is_flat(light)) entry["axis"] = to_json(light.axis);
        list.push_back(std::move(entry));
    }
    Json all{{"lights", list}};
    if (ambient != glm::dvec3(0)) all["ambient"] = to_json(ambient);
    for (const AreaLight& window : windows) {
        Json entry{{"center", to_json(window.center_m)},
                   {"half_u", to_json(window.half_u_m)},
                   {"half_v", to_json(window.half_v_m)},
                   {"radiance", to_json(window.radiance)}};
        if (window.clipped) entry["clipped"] = true;
        all["area"].push_back(std::move(entry));
    }
    write_bytes(file, all.dump(2) + "\n");
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
    write_bytes(file, Json{{"materials", list}}.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::vector<Light> read_lights(const std::filesystem::path& file) {
    const std::vector<JsonValue> elements = JsonValue::read(file).at("lights").elements();
    if (elements.size() > kMostLights)
        throw Error(file.string(), ": lights has ", elements.size(), " elements, at most ", kMostLights, " are read");
    std::vector<Light> lights;
    for (const JsonValue& light : elements) {
        const auto radius = light.find("radius"), axis = light.find("axis");
        lights.push_back({read_vector(light.at("position")), read_intensity(light.at("intensity")),
                          radius ? radius->not_negative() : 0,
                          axis ? glm::normalize(read_direction(*axis)) : glm::dvec3(0)});
        if (axis && is_sun(lights.back())) axis->fail("must not be there: the lamp is a sun, 5 km away or farther");
    }
    return lights;
}

glm::dvec3 read_ambient(const std::filesystem::path& file) {
    const auto ambient = JsonValue::read(file).find("ambient");
    return ambient ? read_intensity(*ambient) : glm::dvec3(0);
}

std::vector<AreaLight> read_windows(const std::filesystem::path& file) {
    const auto area = JsonValue::read(file).find("area");
    if (!area) return {};
    const std::vector<JsonValue> elements = area->elements();
    if (elements.size() > kMostLights)
        throw Error(file.string(), ": area has ", elements.size(), " elements, at most ", kMostLights, " are read");
    std::vector<AreaLight> windows;
    for (const JsonValue& window : elements) {
        const auto clipped = window.find("clipped");
        windows.push_back({read_vector(window.at("center")), read_vector(window.at("half_u")),
                           read_vector(window.at("half_v")), read_intensity(window.at("radiance")),
                           clipped && clipped->boolean()});
        if (!(glm::length(glm::cross(windows.back().half_u_m, windows.back().half_v_m)) > 0))
            window.fail("must have an area: half_u and half_v are 0, or parallel");
    }
    return windows;
}

std::vector<Material> read_materials(const std::filesystem::path& file) {
    std::vector<Material> materials;
    std::set<uint32_t> ids;
    for (const JsonValue& value : JsonValue::read(file).at("materials").elements()) {
        const JsonValue id = value.at("id");
        const Material material{read_label(id), value.at("name").string(), read_kd(value.at("kd")),
                                read_albedo(value.at("ks")), read_alpha(value.at("alpha"))};
        if (!ids.insert(material.id).second) id.fail("which is another material's");
        materials.push_back(material);
    }
    return materials;
}

}  // namespace patina::sensor

namespace patina {

Lighting read_lighting(const std::filesystem::path& file) {
    return {.lights = sensor::read_lights(file),
            .ambient = sensor::read_ambient(file),
            .found_by = "file",
            .windows = sensor::read_windows(file)};
}

void write_lighting(const std::filesystem::path& file, const Lighting& lighting) {
    sensor::write_lights(file, lighting.lights, lighting.ambient, lighting.windows);
}

}  // namespace patina
