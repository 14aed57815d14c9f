#include "export/gltf_material.h"

#include <algorithm>
#include <cmath>

namespace patina {
namespace {

constexpr float kLeastRoughness = 0.045f, kMostSpecular = 0.98f, kNoSpecular = 0.001f;
constexpr float kMetalSpecular = 0.25f, kMetalDiffuse = 0.04f;
constexpr float kDielectricF0 = 0.04f;  // of glTF's core material

/// F0 of a GGX lobe over ks of Ward's lobe with 1 / sqrt(cos_i cos_o), so that both reflect the same share at 30
/// degrees within about 1 %.
float ggx_over_ward(float alpha) { return 0.868f - 0.22f * alpha; }

float largest(glm::vec3 v) { return std::max({v.r, v.g, v.b}); }
float luminance(glm::vec3 rgb) { return glm::dot(rgb, glm::vec3(0.2126f, 0.7152f, 0.0722f)); }

}  // namespace

GltfMaterial gltf_material(const WardGloss& gloss, glm::vec3 kd) {
    GltfMaterial material;
    material.roughness = std::clamp(std::sqrt(gloss.alpha), kLeastRoughness, 1.0f);
    const glm::vec3 f0 = gloss.ks * ggx_over_ward(gloss.alpha);
    const float strength = std::min(largest(f0), kMostSpecular);
    material.metal = strength > kMetalSpecular && luminance(kd) < kMetalDiffuse;
    if (material.metal) {
        material.base_color = glm::min(f0, 1.0f);
    } else if (strength >= kNoSpecular) {
        material.specular = strength;
        material.specular_color = f0 / (kDielectricF0 * strength);
    }
    return material;
}

glm::vec3 base_color_of(const GltfMaterial& material, glm::vec3 kd) { return kd / (1 - material.specular); }

glm::vec3 kd_of(const GltfMaterial& material, glm::vec3 base_color) { return base_color * (1 - material.specular); }

WardGloss ward_of(const GltfMaterial& material) {
    const float alpha = material.roughness * material.roughness;
    const glm::vec3 f0 = material.metal ? material.base_color
                                        : glm::min(kDielectricF0 * material.specular_color, 1.0f) * material.specular;
    return {f0 / ggx_over_ward(alpha), alpha};
}

}  // namespace patina
