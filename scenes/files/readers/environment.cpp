#include "scenes/files/readers/environment.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "scenes/files/readers/values.h"
#include "scenes/render/environment.h"

namespace patina::scenes {
namespace {

constexpr uint64_t kLargestHeight_px = 4096;

/// Members that a drawn environment may leave out keep their defaults.
void read_into(const sensor::JsonValue& value, const char* key, glm::vec3& radiance) {
    if (const auto member = value.find(key)) radiance = glm::vec3(read_rgb(*member, kLargestValue));
}

void read_into(const sensor::JsonValue& value, const char* key, float& angle_rad) {
    if (const auto member = value.find(key)) angle_rad = static_cast<float>(read_degrees(*member));
}

UniformEnvironment read_uniform(const sensor::JsonValue& value) {
    value.expect_keys({"radiance"});
    return {glm::vec3(read_rgb(value.at("radiance"), kLargestValue))};
}

SkyEnvironment read_sky(const sensor::JsonValue& value) {
    value.expect_keys({"zenith", "horizon", "ground", "sun_irradiance", "sun_azimuth_degrees", "sun_elevation_degrees",
                       "sun_radius_degrees"});
    SkyEnvironment sky;
    read_into(value, "zenith", sky.zenith);
    read_into(value, "horizon", sky.horizon);
    read_into(value, "ground", sky.ground);
    read_into(value, "sun_irradiance", sky.sun_irradiance);
    read_into(value, "sun_azimuth_degrees", sky.sun_azimuth_rad);
    read_into(value, "sun_elevation_degrees", sky.sun_elevation_rad);
    if (const auto radius = value.find("sun_radius_degrees")) radius->number_within(0.01, 90);
    read_into(value, "sun_radius_degrees", sky.sun_radius_rad);
    return sky;
}

SoftBox read_soft_box(const sensor::JsonValue& value) {
    value.expect_keys({"azimuth_degrees", "elevation_degrees", "size_degrees", "radiance"});
    SoftBox box;
    read_into(value, "azimuth_degrees", box.azimuth_rad);
    read_into(value, "elevation_degrees", box.elevation_rad);
    if (const auto size = value.find("size_degrees")) {
        for (int i = 0; i < 2; ++i) {
            const sensor::JsonValue side = size->elements_of(2)[size_t(i)];
            side.number_within(0.01, 360);
            box.half_size_rad[i] = static_cast<float>(read_degrees(side) / 2);
        }
    }
    read_into(value, "radiance", box.radiance);
    return box;
}

StudioEnvironment read_studio(const sensor::JsonValue& value) {
    value.expect_keys({"walls", "boxes"});
    StudioEnvironment studio;
    read_into(value, "walls", studio.walls);
    for (const sensor::JsonValue& box : value.at("boxes").elements()) studio.boxes.push_back(read_soft_box(box));
    return studio;
}

Extent2D read_extent(const sensor::JsonValue& value) {
    uint32_t height = 256;
    if (const auto member = value.find("height")) {
        member->positive_integer();
        height = static_cast<uint32_t>(member->whole_number(kLargestHeight_px));
    }
    return {2 * height, height};
}

Image<glm::vec3> read_radiance_file(const sensor::JsonValue& name) {
    const std::filesystem::path file = beside_file(name);
    return located(name, [&] { return read_environment(file); });
}

Image<glm::vec3> read_picture(const std::string& kind, const sensor::JsonValue& source, Extent2D extent) {
    const auto draw = [&](const auto& settings) {
        return located(source, [&] { return draw_environment(settings, extent); });
    };
    if (kind == "uniform") return draw(read_uniform(source));
    if (kind == "sky") return draw(read_sky(source));
    if (kind == "studio") return draw(read_studio(source));
    return read_radiance_file(source);
}

}  // namespace

Environment read_environment(const sensor::JsonValue& value) {
    const auto [kind, source] = read_kind(value, {"file", "sky", "studio", "uniform"}, {"height", "scale"});
    Image<glm::vec3> radiance = read_picture(kind, source, read_extent(value));
    if (const auto scale = value.find("scale")) {
        const auto factor = static_cast<float>(scale->number_within(0, kLargestValue));
        for (glm::vec3& pixel : radiance.pixels()) pixel *= factor;
    }
    return {std::make_shared<const Image<glm::vec3>>(std::move(radiance))};
}

}  // namespace patina::scenes
