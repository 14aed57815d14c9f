#pragma once

#include <array>
#include <vector>

#include "tests/reference/reflectance/refine_albedo.h"

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
    glm::dvec3 ks{0.04};
    double alpha = 0.2;
    double ks_deviation = 0.15;
    double alpha_deviation = 1.3;  ///< octaves
    double correlated = 50;        ///< so many observations are as good as one that is independent
};

/// Fits of one segment, each told by those before it: kd is free for each voxel and channel, the result the means of ks
/// and log(alpha) over how likely they are, alpha from 0.02 to 0.6. Views below a cosine of 0.15 are left out.
class WardFitSeries {
  public:
    explicit WardFitSeries(const SpecularPrior& prior, glm::dvec3 ambient = glm::dvec3(0));

    /// One more fit; 93 % of what the one before summed up counts beside it. Clipped channels are left out of the
    /// first; later they count, for each alpha, where the ks that was found for it predicts less than was recorded.
    Ward fit(const std::vector<FittedVoxel>& voxels);

    /// How sure the last one is: the share of ks that observations tell, less where alpha is spread.
    double confidence() const { return confidence_; }

    /// The kd that, as one for all voxels, leaves the least squared error of what highlights leave of their unclipped
    /// colours; from the fourth fit on as of every fourth. 0 without any.
    glm::dvec3 kd() const;

  private:
    /// One channel of all voxels, for one alpha: residuals are color - ks * lobe, each without its voxel's mean.
    struct Line {
        double lobe2 = 0, product = 0, color2 = 0, count = 0;
    };
    struct Solution {
        glm::dvec3 ks{0};
        double score = 0;   ///< -2 log of how likely the alpha is, times the unit
        double misfit = 0;  ///< the weighted sum of squared errors
        double told = 0;    ///< the share of ks that observations tell
    };
    struct Weighed;

    Weighed weigh(const FittedVoxel& voxel) const;
    std::array<Line, 3> sum(const std::vector<Weighed>& voxels, size_t step) const;
    Solution solve(size_t step) const;
    void set_estimate();
    void doubt_blue();
    void sum_diffuse(const std::vector<Weighed>& voxels);

    SpecularPrior prior_;
    glm::dvec3 ambient_;
    int fits_ = 0;
    // By alpha:
    std::vector<std::array<Line, 3>> lines_;
    std::vector<double> seen_;  ///< voxels near its peak
    std::vector<Solution> solutions_;
    // What the fits so far say:
    Ward estimate_{};
    double deviation_ = 1;
    double confidence_ = 0;
    glm::dvec3 diffuse_{0}, light2_{0};
    double unit_ = 1;  ///< of sums, what is as unlikely as one deviation of one independent observation
};

}  // namespace patina::reference
