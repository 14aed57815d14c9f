#include "sensor/synthetic/scene.h"

#include <algorithm>
#include <iterator>
#include <numbers>

namespace patina::sensor {

std::vector<Material> materials_of(const Scene& scene) {
    std::vector<Material> materials;
    std::transform(scene.objects.begin(), scene.objects.end(), std::back_inserter(materials),
                   [](const SceneObject& object) { return object.material; });
    return materials;
}

glm::dvec3 emitted_radiance(const PointLight& light) {
    if (light.radius_m == 0) return glm::dvec3(0);
    return light.intensity / (std::numbers::pi * light.radius_m * light.radius_m);
}

}  // namespace patina::sensor
