#include "passes/state/lights.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/core/error.h"
#include "engine/core/shader_light.h"

namespace patina {

namespace {

constexpr float kAxisError = 1e-3f;  // of its length: files have six digits

bool finite(glm::vec3 v) { return !glm::any(glm::isnan(v)) && !glm::any(glm::isinf(v)); }
bool a_power(glm::vec3 v) { return finite(v) && glm::all(glm::greaterThanEqual(v, glm::vec3(0))); }

bool is_sound(const gpu::PointLight& light) {
    return finite(glm::vec3(light.position_m)) && a_power(glm::vec3(light.intensity)) &&
           a_power(glm::vec3(light.position_m.w)) && std::abs(glm::length(light.axis) - 1) < kAxisError &&
           (light.intensity.w == 0 || light.axis.w == 1);
}

bool same_place(const gpu::PointLight& a, const gpu::PointLight& b) { return a.position_m == b.position_m; }
bool same_light(const gpu::PointLight& a, const gpu::PointLight& b) {
    return same_place(a, b) && a.intensity == b.intensity && a.axis == b.axis;
}

}  // namespace

void Lights::set(std::span<const Light> lights, glm::dvec3 ambient_term) {
    const glm::vec3 ambient(ambient_term);
    if (lights.size() > gpu::kMaxPointLights) {
        throw Error("there are ", lights.size(), " lights, at most ", gpu::kMaxPointLights, " can be used");
    }
    if (!a_power(ambient)) throw Error("the ambient light is negative or not finite");
    std::vector<gpu::PointLight> now;
    for (const Light& light : lights) {
        now.push_back(make_point_light(light));
        if (!is_sound(now.back())) {
            throw Error("light ", now.size() - 1,
                        " has a position, an intensity or a radius that is negative or not finite, or an axis whose "
                        "length is not 1, or it is a sun with an axis");
        }
    }
    const bool same_places = std::ranges::equal(now, lights_, same_place);
    const bool same = ambient == ambient_ && std::ranges::equal(now, lights_, same_light);
    if (!same_places) ++position_version_;
    if (!same) ++version_;
    lights_ = std::move(now);
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
    std::ranges::copy(lights_, content.lights);
    return frame.upload<Content>("lights", std::span(&content, 1));
}

void Lights::visit(graph::StateVisitor& visitor) {
    visitor.values("lights.points", lights_);
    visitor.value("lights.ambient", ambient_);
    visitor.value("lights.version", version_);
    visitor.value("lights.position_version", position_version_);
}

}  // namespace patina
