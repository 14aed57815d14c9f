#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace patina::reference {

/// What rays brought to a place on a surface.
struct GatheredRays {
    glm::dvec3 mean{0};            ///< radiance where a ray met something
    uint32_t met = 0, missed = 0;  ///< rays
};

/// A place on a surface, one of a grid of cells.
struct GatheringPlace {
    glm::ivec3 cell{0};
    glm::dvec3 point_m{0}, normal{0};
    GatheredRays rays;
};

/// For each place all rays of the places in the cells around it, itself among them, whose normals are within 25.8
/// degrees of its own and which lie less than `edge_m`, a cell's edge, off its tangent plane. They count as so many
/// rays, 8 to 192, of a relative deviation of 0.5 each, as the mean is worth by how far the places differ; no more than
/// there are.
std::vector<GatheredRays> smooth_irradiance(const std::vector<GatheringPlace>& places, double edge_m);

}  // namespace patina::reference
