#include "sensor/synthetic/readers/environment.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sensor/synthetic/environment.h"
#include "sensor/synthetic/readers/values.h"

namespace patina::sensor {
namespace {

constexpr Extent2D kDrawn{256, 128};  // pixels of 1.4 degrees

void read_rgb_member(const JsonValue& value, const char* key, glm::vec3& rgb) {
    if (const auto member = value.find(key)) rgb = glm::vec3(read_rgb(*member, kLargestValue));
}

void read_degrees_member(const JsonValue& value, const char* key, float& angle_rad) {
    if (const auto member = value.find(key)) angle_rad = static_cast<float>(read_degrees(*member));
}

UniformEnvironment read_uniform(const JsonValue& value) {
    value.expect_keys({"radiance"});
    UniformEnvironment uniform;
    read_rgb_member(value, "radiance", uniform.radiance);
    return uniform;
}

SkyEnvironment read_sky(const JsonValue& value) {
    value.expect_keys({"zenith", "horizon", "ground", "sun_irradiance", "sun_azimuth_degrees", "sun_elevation_degrees",
                       "sun_radius_degrees"});
    SkyEnvironment sky;
    read_rgb_member(value, "zenith", sky.zenith);
    read_rgb_member(value, "horizon", sky.horizon);
    read_rgb_member(value, "ground", sky.ground);
    read_rgb_member(value, "sun_irradiance", sky.sun_irradiance);
    read_degrees_member(value, "sun_azimuth_degrees", sky.sun_azimuth_rad);
    read_degrees_member(value, "sun_elevation_degrees", sky.sun_elevation_rad);
    read_degrees_member(value, "sun_radius_degrees", sky.sun_radius_rad);
    return sky;
}

SoftBox read_box(const JsonValue& value) {
    value.expect_keys({"azimuth_degrees", "elevation_degrees", "size_degrees", "radiance"});
    SoftBox box;
    read_degrees_member(value, "azimuth_degrees", box.azimuth_rad);
    read_degrees_member(value, "elevation_degrees", box.elevation_rad);
    read_rgb_member(value, "radiance", box.radiance);
    if (const auto size = value.find("size_degrees")) {
        const std::vector<JsonValue> sides = size->elements();
        if (sides.size() != 2) size->fail("must be two angles, across and up");
        for (int i = 0; i < 2; ++i) {
            const JsonValue& side = sides[static_cast<size_t>(i)];
            if (!(side.number_within(0, 360) > 0)) side.fail("must be above 0");
            box.half_size_rad[i] = static_cast<float>(read_degrees(side) / 2);
        }
    }
    return box;
}

StudioEnvironment read_studio(const JsonValue& value) {
    value.expect_keys({"walls", "boxes"});
    StudioEnvironment studio;
    read_rgb_member(value, "walls", studio.walls);
    for (const JsonValue& box : value.at("boxes").elements()) studio.boxes.push_back(read_box(box));
    return studio;
}

Image<glm::vec3> read_picture(const std::string& kind, const JsonValue& value) {
    if (kind == "uniform") return draw_environment(read_uniform(value), kDrawn);
    if (kind == "sky") return draw_environment(read_sky(value), kDrawn);
    if (kind == "studio") return draw_environment(read_studio(value), kDrawn);
    return located(value, [&] { return read_environment(beside_file(value)); });
}

}  // namespace

Environment read_environment(const JsonValue& value) {
    value.expect_keys({"uniform", "sky", "studio", "file", "scale"});
    const auto [kind, settings] = read_kind(value, {"uniform", "sky", "studio", "file"});
    Image<glm::vec3> picture = read_picture(kind, settings);
    if (const auto scale = value.find("scale")) {
        const auto factor = static_cast<float>(scale->number_within(0, kLargestValue));
        for (glm::vec3& radiance : picture.pixels()) radiance *= factor;
    }
    return {std::make_shared<const Image<glm::vec3>>(std::move(picture))};
}

}  // namespace patina::sensor
