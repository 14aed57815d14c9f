#include "sensor/synthetic/readers/lights.h"

#include "sensor/synthetic/readers/values.h"

namespace patina::sensor {
namespace {

PointLight read_light(const JsonValue& value) {
    value.expect_keys({"position", "intensity", "radius"});
    PointLight light{read_vector(value.at("position")), read_rgb(value.at("intensity"), kLargestValue)};
    if (const auto radius = value.find("radius")) light.radius_m = radius->number_within(0, kLargestValue);
    return light;
}

}  // namespace

std::vector<PointLight> read_lights(const JsonValue& value) {
    std::vector<PointLight> lights;
    for (const JsonValue& element : value.elements()) lights.push_back(read_light(element));
    return lights;
}

}  // namespace patina::sensor
