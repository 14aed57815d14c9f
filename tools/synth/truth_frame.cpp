#include "tools/synth/truth_frame.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace patina::tools {
namespace {

glm::vec3 mean_of(const Image<glm::vec3>& picture) {
    const auto& pixels = picture.pixels();
    const glm::dvec3 sum = std::accumulate(pixels.begin(), pixels.end(), glm::dvec3(0),
                                           [](glm::dvec3 a, glm::vec3 b) { return a + glm::dvec3(b); });
    return glm::vec3(sum / static_cast<double>(pixels.size()));
}

/// Each object's kd by its id; 0 has none.
std::unordered_map<uint32_t, glm::vec3> mean_kd_of(const scenes::SyntheticScene& scene) {
    std::unordered_map<uint32_t, glm::vec3> kd{{0, glm::vec3(0)}};
    for (const scenes::SceneObject& object : scene.objects) {
        kd[object.material.id] = object.material.kd ? glm::vec3(*object.material.kd) : mean_of(*object.texture->kd);
    }
    return kd;
}

template <class To, class From, class Convert>
Image<To> converted(const Image<From>& from, Convert convert) {
    Image<To> to(from.extent());
    std::transform(from.pixels().begin(), from.pixels().end(), to.pixels().begin(), convert);
    return to;
}

}  // namespace

FrameDump truth_dump(const scenes::SyntheticScene& scene, const scenes::FrameTruth::Seen& seen) {
    const auto xyz = [](const glm::vec4& v) { return glm::vec3(v); };
    const auto mean_kd = mean_kd_of(scene);
    return {.rgb = converted<glm::vec3>(seen.radiance, xyz),
            .depth_m = seen.depth_m,
            .normal = converted<glm::vec3>(seen.normal, xyz),
            .valid = converted<float>(seen.depth_m, [](float z) { return z > 0 ? 1.0f : 0.0f; }),
            .kd = converted<glm::vec3>(seen.kd, xyz),
            .ks = converted<glm::vec3>(seen.ks_alpha, xyz),
            .alpha = converted<float>(seen.ks_alpha, [](const glm::vec4& v) { return v.a; }),
            .kd_segment = converted<glm::vec3>(seen.object_id, [&](uint32_t id) { return mean_kd.at(id); }),
            .rgb_segment = {},
            .kd_shown = {},
            .rgb_shown = {},
            .label = converted<float>(seen.object_id, [](uint32_t id) { return static_cast<float>(id); })};
}

}  // namespace patina::tools
