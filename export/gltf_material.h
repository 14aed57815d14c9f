#pragma once

#include <glm/glm.hpp>

#include "patina/scene.h"

namespace patina {

/// A glTF 2.0 material, metallic-roughness with KHR_materials_specular.
struct GltfMaterial {
    bool metal = false;           ///< metallic 1, without the specular extension; else a dielectric
    float roughness = 1;          ///< the square root of the width of the lobe
    float specular = 0;           ///< specularFactor, of dielectrics
    glm::vec3 specular_color{1};  ///< specularColorFactor, of dielectrics
    glm::vec3 base_color{1};      ///< of metals; that of dielectrics is per vertex, base_color_of()
};

/// The glTF material nearest to a segment's: a GGX lobe as wide as Ward's and as strong at normal incidence, with
/// Fresnel's factor constant in the strongest channel, as Ward has none. GGX has longer tails: lobes differ by 27 to
/// 37 % (relative L2). A segment is a metal where it is bright at normal incidence and has next to no diffuse `kd`.
GltfMaterial gltf_material(const WardGloss& gloss, glm::vec3 kd);

/// The base colour that makes a dielectric's diffuse part `kd`; may exceed 1, which a file cannot hold.
glm::vec3 base_color_of(const GltfMaterial& material, glm::vec3 kd);

/// The inverses: kd of a dielectric's base colour, and ks and alpha of a material. Exact but for the clamps on
/// roughness (alpha below 0.002) and on specular strength (above 0.98).
glm::vec3 kd_of(const GltfMaterial& material, glm::vec3 base_color);
WardGloss ward_of(const GltfMaterial& material);

}  // namespace patina
