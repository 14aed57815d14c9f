#include "reconstruction/far_field.h"

#include <algorithm>

namespace patina {
namespace {

constexpr uint32_t kFiner = gpu::kOpeningEdge / gpu::kFarFieldEdge;  // texels of openings along the side of one

glm::vec4 sum_of(const gpu::SurroundingsSums& sums) {
    return {glm::vec3(sums.r, sums.g, sums.b) / gpu::kSurroundingsSteps, sums.samples};
}

}  // namespace

glm::vec4 mean_radiance(const gpu::SurroundingsLight& light) {
    const glm::vec4 usual = sum_of(light.usual), low = sum_of(light.low);
    if (usual.a + low.a < gpu::kLeastSurroundingsSamples) return glm::vec4(0);
    const bool clipped = usual.a == 0 || std::max({usual.r, usual.g, usual.b}) > gpu::kNearlyClipped * usual.a;
    const glm::vec4& told = low.a > 0 && clipped ? low : usual;
    return told / told.a;
}

namespace {

glm::vec4 seen_in_openings(std::span<const gpu::OpeningTexel> openings, glm::uvec2 texel) {
    glm::vec4 sum(0);
    for (uint32_t y = 0; y < kFiner; ++y)
        for (uint32_t x = 0; x < kFiner; ++x)
            sum += mean_radiance(openings[(kFiner * texel.y + y) * gpu::kOpeningEdge + kFiner * texel.x + x].light);
    return sum.a > 0 ? sum / sum.a : sum;
}

}  // namespace

Image<glm::vec4> far_field_of(std::span<const gpu::FarFieldTexel> sky, std::span<const gpu::OpeningTexel> openings) {
    Image<glm::vec4> far_field({gpu::kFarFieldEdge, gpu::kFarFieldEdge}, glm::vec4(0));
    for (uint32_t i = 0; i < gpu::kFarFieldTexels; ++i) {
        glm::vec4& radiance = far_field.pixels()[i];
        radiance = seen_in_openings(openings, {i % gpu::kFarFieldEdge, i / gpu::kFarFieldEdge});
        const glm::vec4 sums(sky[i].sums);
        if (radiance.a == 0 && sums.w > 0) radiance = glm::vec4(glm::vec3(sums) / (sums.w * gpu::kFarFieldSteps), 1);
    }
    return far_field;
}

}  // namespace patina
