#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace patina::reference {

/// What a fit summed up for one alpha, times what the lobe is scaled by.
struct AlphaSums {
    double alpha = 0;
    glm::dvec3 lobe2{0};    ///< of squared lobes
    glm::dvec3 product{0};  ///< of lobe times colour
    double seen = 0;        ///< voxels near the peak
};

/// A segment whose material is to be bounded.
struct BoundedSegment {
    std::vector<AlphaSums> sums;  ///< by alpha, equal steps of its logarithm
    double deviation = 0;         ///< of observations, in units of what is expected
    glm::dvec3 ks{0};             ///< the estimate
    double alpha = 1;
    double fit_confidence = 0;
    std::optional<glm::dvec3> kd;          ///< mean over voxels
    std::optional<glm::dvec3> squares_kd;  ///< of least squares
};

/// Where ks (0 to 2), alpha (3) and kd (4 to 6) lie.
struct BoundedMaterial {
    std::array<double, 7> low{}, high{};
    double confidence = 0;
};

/// The interval of a probability, as docs/develop/specular.md describes it; ends by a table of the distribution.
BoundedMaterial bound_material(const BoundedSegment& segment, double probability);

}  // namespace patina::reference
