#pragma once

#include <vector>

#include "tests/reference/refine_albedo.h"

namespace patina::reference {

/// A voxel of a segment, as a fit sees it. Its lights are those that reach it.
struct FittedVoxel {
    SurfacePoint point;
    std::vector<SeenColor> observations;
    std::vector<ReceivedLight> lights;
};

/// What is thought of a material before anything is seen of it.
struct SpecularPrior {
    glm::dvec3 ks{0};
    double alpha = 0.2;
    double ks_weight = 0;     ///< of squared differences from ks, beside squared errors over their variances
    double alpha_weight = 0;  ///< and of squared octaves from alpha
};

/// ks and alpha of the least weighted squared error, kd being free for each voxel and channel; alpha from 0.02 to 0.6.
/// Clipped channels and views below a cosine of 0.15 are left out.
Ward fit_ward(const std::vector<FittedVoxel>& voxels, const SpecularPrior& prior);

}  // namespace patina::reference
