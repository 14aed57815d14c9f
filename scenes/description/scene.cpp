#include "scenes/description/scene.h"

#include <algorithm>
#include <iterator>
#include <numbers>

namespace patina::scenes {

std::vector<sensor::Material> materials_of(const SyntheticScene& scene) {
    std::vector<sensor::Material> materials;
    std::transform(scene.objects.begin(), scene.objects.end(), std::back_inserter(materials),
                   [](const SceneObject& object) { return object.material; });
    return materials;
}

glm::dvec3 emitted_radiance(const Light& light) {
    if (light.radius_m == 0) return glm::dvec3(0);
    return light.intensity / (std::numbers::pi * light.radius_m * light.radius_m);
}

}  // namespace patina::scenes
