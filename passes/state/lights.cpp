#include "passes/state/lights.h"

#include <algorithm>
#include <cstring>

#include "engine/core/error.h"

namespace patina {

namespace {

bool finite(glm::vec3 v) { return !glm::any(glm::isnan(v)) && !glm::any(glm::isinf(v)); }
bool a_power(glm::vec3 v) { return finite(v) && glm::all(glm::greaterThanEqual(v, glm::vec3(0))); }

bool same_place(const PointLight& a, const PointLight& b) {
    return a.position_m == b.position_m && a.radius_m == b.radius_m;
}

}  // namespace

std::vector<PointLight> point_lights(std::span<const Light> lights) {
    std::vector<PointLight> lamps;
    for (const Light& light : lights)
        lamps.push_back({glm::vec3(light.position_m), glm::vec3(light.intensity), static_cast<float>(light.radius_m)});
    return lamps;
}

void Lights::set(std::span<const PointLight> lights, glm::vec3 ambient) {
    if (lights.size() > gpu::kMaxPointLights) {
        throw Error("there are ", lights.size(), " lights, at most ", gpu::kMaxPointLights, " can be used");
    }
    if (!a_power(ambient)) throw Error("the ambient light is negative or not finite");
    for (size_t i = 0; i < lights.size(); ++i) {
        if (!finite(lights[i].position_m) || !a_power(lights[i].intensity) || !a_power(glm::vec3(lights[i].radius_m))) {
            throw Error("light ", i, " has a position, an intensity or a radius that is negative or not finite");
        }
    }
    const bool same_places = std::equal(lights.begin(), lights.end(), lights_.begin(), lights_.end(), same_place);
    const bool same = ambient == ambient_ && std::equal(lights.begin(), lights.end(), lights_.begin(), lights_.end());
    if (!same_places) ++position_version_;
    if (!same) ++version_;
    lights_.assign(lights.begin(), lights.end());
    ambient_ = ambient;
}

graph::BufferId Lights::upload(graph::FrameGraph& frame) const {
    struct Content {
        gpu::LightHeader header{};
        gpu::PointLight lights[gpu::kMaxPointLights]{};
    } content;
    content.header.ambient = glm::vec4(ambient_, 0);
    content.header.count = static_cast<uint32_t>(lights_.size());
    content.header.version = version_;
    content.header.position_version = position_version_;
    for (size_t i = 0; i < lights_.size(); ++i) {
        content.lights[i] = {glm::vec4(lights_[i].position_m, lights_[i].radius_m), glm::vec4(lights_[i].intensity, 0)};
    }
    return frame.upload<Content>("lights", std::span(&content, 1));
}

}  // namespace patina
