#pragma once

#include <array>
#include <vector>

#include <glm/glm.hpp>

#include "tests/reference/reflectance/smooth_irradiance.h"
#include "tests/reference/shading/ward.h"

namespace patina::reference {

/// What one direction saw of a surface point.
struct SeenColor {
    glm::dvec3 to_viewer;
    glm::dvec3 rgb;
    std::array<bool, 3> clipped{};
};

/// A point light as it reaches a surface point.
struct ReceivedLight {
    glm::dvec3 position_m;
    glm::dvec3 intensity;
    bool reaches = true;
    bool uncertain = false;
    glm::dvec3 axis{0};  ///< of a flat lamp
};

struct SurfacePoint {
    glm::dvec3 position_m;
    glm::dvec3 normal;
};

struct RefinedAlbedo {
    glm::dvec3 kd{0};
    glm::dvec3 certainty{0};  ///< 0: unknown
};

/// The colour of a surface point seen from a direction (paper, Eq. 6), with an ambient term: irradiance over pi.
glm::dvec3 shade(const Ward& material, const SurfacePoint& point, const std::vector<ReceivedLight>& lights,
                 glm::dvec3 ambient, glm::dvec3 to_viewer);

/// The diffuse albedo of a surface point from its observations (paper, Eq. 7), the robust mean of
/// passes/reflectance/refine_albedo.h; `material`'s kd is not used. With rays that were gathered, what they met takes
/// the ambient term's place, in the share of those that met something. `mirror`: how sure the segment is to have no
/// diffuse part, 0 to 1. `low`: radiance at low exposure, which counts where a channel is clipped in all views and it
/// is brighter; 0: not known.
RefinedAlbedo refine_albedo(const std::vector<SeenColor>& observations, const SurfacePoint& point,
                            const std::vector<ReceivedLight>& lights, glm::dvec3 ambient, const Ward& material,
                            const GatheredRays& gathered = {}, double mirror = 0, glm::dvec3 low = glm::dvec3(0));

}  // namespace patina::reference
