#include "tests/reference/lighting/received.h"

#include <algorithm>
#include <numbers>

namespace patina::reference {

float received(const Receiver& receiver, glm::vec3 lamp_m) {
    const glm::vec3 offset_m = lamp_m - receiver.point_m;
    const float distance_m = glm::length(offset_m);
    const float cosine = glm::dot(offset_m, receiver.normal) / distance_m;
    return std::max(cosine, 0.0f) / (std::numbers::pi_v<float> * distance_m * distance_m);
}

std::vector<float> received(std::span<const Receiver> receivers, glm::vec3 lamp_m) {
    std::vector<float> row;
    row.reserve(receivers.size());
    for (const Receiver& receiver : receivers) row.push_back(received(receiver, lamp_m));
    return row;
}

}  // namespace patina::reference
