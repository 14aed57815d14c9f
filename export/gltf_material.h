#pragma once

#include <glm/glm.hpp>

#include "patina/scene.h"

namespace patina {

/// How a dielectric's lobe changes with the angle of incidence.
enum class GltfFresnel {
    kIor,       ///< as glass does: the index of refraction has the strength, every factor is within 0..1
    kConstant,  ///< not at all, as Ward's; specularColorFactor goes up to 25, which some readers refuse
};

/// A glTF 2.0 material, metallic-roughness with KHR_materials_ior and KHR_materials_specular.
struct GltfMaterial {
    bool metal = false;           ///< metallic 1, without the extensions; else a dielectric
    bool observed = false;        ///< the gloss is more than a guess, and strong enough to be seen
    float roughness = 1;          ///< the square root of the width of the lobe
    float ior = 1.5f;             ///< index of refraction, of dielectrics
    float specular = 0;           ///< specularFactor, of dielectrics
    glm::vec3 specular_color{1};  ///< specularColorFactor, of dielectrics
    glm::vec3 base_color{1};      ///< of metals; that of dielectrics is per vertex, base_color_of()
};

/// A fit of this confidence or more is an observation (WardGloss::confidence); what is given without one is, too.
inline constexpr float kObservedConfidence = 0.5f;
bool is_observed(const WardGloss& gloss);

/// The glTF material nearest to a segment's: a GGX lobe as wide as Ward's and as strong at normal incidence. GGX has
/// longer tails: lobes differ by 27 to 37 % (relative L2). With kIor a grazing highlight is brighter than Ward's, who
/// has no Fresnel factor.
///
/// A segment is a metal where it was observed to be bright at normal incidence (0.25) and has next to no diffuse `kd`
/// (luminance below 0.04). Gloss that was not observed, or reflects less than 0.002, is a colourless dielectric of
/// index 1.5 at most; of index 1 without any.
GltfMaterial gltf_material(const WardGloss& gloss, glm::vec3 kd, GltfFresnel fresnel = GltfFresnel::kIor);

/// Whether a dielectric needs KHR_materials_specular. Without tint and beside an index of refraction it says nothing,
/// and Blender 3.4 makes an image as large as the page of each material that has it (0.1 GB for 2900 x 2900 texels). Of
/// gloss that was observed Blender takes the strength from the index only where the extension is there.
bool needs_specular(const GltfMaterial& material);

/// What a material reflects at normal incidence.
glm::vec3 f0_of(const GltfMaterial& material);

/// The base colour that makes a dielectric's diffuse part `kd`; may exceed 1, which a file cannot hold.
glm::vec3 base_color_of(const GltfMaterial& material, glm::vec3 kd);

/// The inverses: kd of a dielectric's base colour, and ks and alpha of a material. Exact but for the clamps on
/// roughness (alpha below 0.002; 1 where next to nothing is reflected) and on specular strength (above 0.6; with
/// kConstant above 0.98).
glm::vec3 kd_of(const GltfMaterial& material, glm::vec3 base_color);
WardGloss ward_of(const GltfMaterial& material);

}  // namespace patina
