#include "scenes/files/readers/lights.h"

#include "scenes/files/readers/values.h"

namespace patina::scenes {
namespace {

Light read_light(const sensor::JsonValue& value) {
    value.expect_keys({"position", "intensity", "radius", "axis"});
    Light light{read_vector(value.at("position")), read_rgb(value.at("intensity"), kLargestValue)};
    if (const auto radius = value.find("radius")) light.radius_m = radius->number_within(0, kLargestValue);
    if (const auto axis = value.find("axis")) light.axis = read_direction(*axis);
    return light;
}

}  // namespace

std::vector<Light> read_lights(const sensor::JsonValue& value) {
    std::vector<Light> lights;
    for (const sensor::JsonValue& element : value.elements()) lights.push_back(read_light(element));
    return lights;
}

}  // namespace patina::scenes
