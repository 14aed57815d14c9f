#include "export/gltf_material.h"

#include <algorithm>
#include <cmath>

#include "engine/core/luminance.h"

namespace patina {
namespace {

constexpr float kLeastRoughness = 0.045f;
constexpr float kMostOfIor = 0.6f;  // an index of 7.9; metals shine more, and are metals
constexpr float kMostOfConstant = 0.98f;
constexpr float kLeastOfIor = 0.002f, kLeastOfConstant = 0.001f;
constexpr float kMetalSpecular = 0.25f, kMetalDiffuse = 0.04f;
constexpr float kCommonIor = 1.5f, kCommonF0 = 0.04f;  // of glTF's core material

/// F0 of a GGX lobe over ks of Ward's lobe with 1 / sqrt(cos_i cos_o), so that both reflect the same share at 30
/// degrees within about 1 %.
float ggx_over_ward(float alpha) { return 0.868f - 0.22f * alpha; }

float largest(glm::vec3 v) { return std::max({v.r, v.g, v.b}); }

/// The index of refraction that reflects `f0` at normal incidence, and the other way.
float ior_of(float f0) { return (1 + std::sqrt(f0)) / (1 - std::sqrt(f0)); }
float f0_of_ior(float ior) { return (ior - 1) / (ior + 1) * ((ior - 1) / (ior + 1)); }

void set_metal(GltfMaterial& material, glm::vec3 f0) {
    material.metal = true;
    material.base_color = glm::min(f0, 1.0f);
}

/// Fresnel's factor is specularFactor where specularColorFactor times 0.04 is 1: it does not change with the angle.
void set_constant(GltfMaterial& material, glm::vec3 f0) {
    const float strength = std::min(largest(f0), kMostOfConstant);
    if (strength < kLeastOfConstant) return;
    material.specular = strength;
    material.specular_color = f0 / (kCommonF0 * strength);
}

void set_ior(GltfMaterial& material, glm::vec3 f0) {
    const float strength = largest(f0);
    material.specular = 1;
    material.ior = ior_of(std::min(strength, material.observed ? kMostOfIor : kCommonF0));
    if (material.observed) material.specular_color = f0 / strength;
    if (strength < kLeastOfIor) material.roughness = 1;  // what is left of it at grazing angles is wide
}

/// What of the light does not reach a dielectric's diffuse part at normal incidence.
float specular_share(const GltfMaterial& material) { return largest(f0_of(material)); }

}  // namespace

bool is_observed(const WardGloss& gloss) { return gloss.confidence.value_or(1.0f) >= kObservedConfidence; }

GltfMaterial gltf_material(const WardGloss& gloss, glm::vec3 kd, GltfFresnel fresnel) {
    GltfMaterial material;
    material.roughness = std::clamp(std::sqrt(gloss.alpha), kLeastRoughness, 1.0f);
    const glm::vec3 f0 = glm::max(gloss.ks, 0.0f) * ggx_over_ward(gloss.alpha);
    material.observed = is_observed(gloss) && largest(f0) >= kLeastOfIor;
    if (material.observed && largest(f0) > kMetalSpecular && luminance(kd) < kMetalDiffuse) {
        set_metal(material, f0);
    } else if (fresnel == GltfFresnel::kConstant) {
        set_constant(material, f0);
    } else {
        set_ior(material, f0);
    }
    return material;
}

bool needs_specular(const GltfMaterial& material) {
    return material.observed || material.specular != 1 || material.specular_color != glm::vec3(1);
}

glm::vec3 f0_of(const GltfMaterial& material) {
    if (material.metal) return material.base_color;
    return glm::min(f0_of_ior(material.ior) * material.specular_color, 1.0f) * material.specular;
}

glm::vec3 base_color_of(const GltfMaterial& material, glm::vec3 kd) { return kd / (1 - specular_share(material)); }

glm::vec3 kd_of(const GltfMaterial& material, glm::vec3 base_color) {
    return base_color * (1 - specular_share(material));
}

WardGloss ward_of(const GltfMaterial& material) {
    const float alpha = material.roughness * material.roughness;
    return {f0_of(material) / ggx_over_ward(alpha), alpha};
}

}  // namespace patina
