#pragma once

#include <vector>

#include "tests/reference/refine_albedo.h"

namespace patina::reference {

/// A voxel of a segment, as a fit sees it. Its lights are those that reach it.
struct FittedVoxel {
    SurfacePoint point;
    std::vector<SeenColor> observations;
    std::vector<ReceivedLight> lights;
    double blur2 = 0;  ///< its highlights are those of a material whose alpha^2 is larger by this, its ks the same
};

/// What is thought of a material before anything is seen of it.
struct SpecularPrior {
    glm::dvec3 ks{0};
    double alpha = 0.2;
    double ks_weight = 1;     ///< of squared differences from ks, beside squared errors over their variances
    double alpha_weight = 0;  ///< and of squared octaves from alpha
    double unit = 1;          ///< of these sums, what is as unlikely as one deviation of one independent observation
};

/// The means of ks and log(alpha) over how likely they are, kd being free for each voxel and channel; alpha from 0.02
/// to 0.6. Views below a cosine of 0.15 are left out, and clipped channels.
Ward fit_ward(const std::vector<FittedVoxel>& voxels, const SpecularPrior& prior);

}  // namespace patina::reference
