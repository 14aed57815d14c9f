#pragma once

#include <span>

#include <glm/glm.hpp>

namespace patina::scenes {

/// A plausible Ward material: linear albedos and roughness, kd + ks below 1 in every channel.
struct TableMaterial {
    const char* name;
    glm::dvec3 kd;
    glm::dvec3 ks;
    double alpha;
};

/// Materials of a household, made up for Patina so that they spread over the range of what has been measured (Ngan,
/// Durand, Matusik 2005): matt paints, fabrics, plastics, woods, rubber, stone and ceramics, metals.
std::span<const TableMaterial> material_table();

}  // namespace patina::scenes
