#include "sensor/camera_json.h"

#include <algorithm>
#include <vector>

#include "engine/core/input_file.h"

namespace patina::sensor {

nlohmann::ordered_json camera_json(const Intrinsics& camera) {
    return {{"width", camera.extent.width},
            {"height", camera.extent.height},
            {"fx", camera.fx},
            {"fy", camera.fy},
            {"cx", camera.cx},
            {"cy", camera.cy},
            {"distortion", camera.distortion}};
}

Intrinsics read_camera(const JsonValue& camera) {
    Intrinsics intrinsics;
    intrinsics.extent = {camera.at("width").positive_integer(), camera.at("height").positive_integer()};
    check_picture_size(camera.where(), intrinsics.extent.width, intrinsics.extent.height);
    intrinsics.fx = camera.at("fx").positive();
    intrinsics.fy = camera.at("fy").positive();
    intrinsics.cx = camera.at("cx").number();
    intrinsics.cy = camera.at("cy").number();
    if (const auto distortion = camera.find("distortion")) {
        const std::vector<double> values = distortion->numbers(intrinsics.distortion.size());
        std::copy(values.begin(), values.end(), intrinsics.distortion.begin());
    }
    return intrinsics;
}

glm::dvec3 read_direction(const JsonValue& value) {
    const std::vector<double> numbers = value.numbers(3);
    const glm::dvec3 direction(numbers[0], numbers[1], numbers[2]);
    if (!(glm::length(direction) > 0)) throw Error(value.where(), " is [0, 0, 0], which is no direction");
    return direction;
}

}  // namespace patina::sensor
