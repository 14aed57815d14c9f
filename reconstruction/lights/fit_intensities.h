#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "shared/lighting/fit_lights.h"

namespace patina {

/// What a lamp of intensity 1 gives the samples of a LitSurface.
struct ReceivedLightValues {
    std::vector<float> by_sample;
    double mean = 0;
};
using ReceivedLight = std::shared_ptr<const ReceivedLightValues>;

/// Which pixel values are explained.
enum class LightChannel : uint8_t { kRed, kGreen, kBlue, kMean };

constexpr float kDarkestSample = 0.004f;    ///< a pixel value of 8-bit noise: what is darker tells nothing
constexpr float kChromaticityStep = 0.06f;  ///< more than what lamps of different colour make of one albedo
constexpr uint32_t kIntensitySteps = 10;    ///< of LitSurface::fit, after which intensities hardly change

/// Lamps' intensities that explain the pixel values of a surface.
struct FittedIntensities {
    std::vector<double> intensities;  ///< one per lamp, then the ambient irradiance over pi; never below 0
    double misfit = 0;                ///< mean robust residual, 0 to 1
    std::vector<float> albedo;        ///< two by group: pi times the radiosity per irradiance; 0: unknown, or none
};

/// Samples of the surface, in groups that are taken to have one albedo each, or one of two that are well apart (grey
/// tiles on grey): samples of one chromaticity within a cube. How bright the albedo is, nobody says: intensities are
/// known up to one factor per channel, and are told such that the mean sample receives an irradiance / pi of 1.
class LitSurface {
  public:
    /// `drawn` as add_sample_surface returns it; `cell_m` is the size of the cubes.
    LitSurface(std::span<const gpu::LightSample> drawn, float cell_m);

    size_t size() const { return samples_.size(); }
    const std::vector<gpu::LightSample>& samples() const { return samples_; }
    const std::vector<gpu::LightSample>& highlights() const { return highlights_; }

    /// One trial's row of add_try_lights for these samples.
    ReceivedLight received(std::span<const float> row) const;

    /// The samples that are among the first so many places; their light is the first part of all vectors.
    size_t samples_before(uint32_t place) const;

    /// Robust non-negative least squares for the intensities of all lamps and the ambient light at once, from the first
    /// `count` samples. A group's albedo k is eliminated: b_i sum_j(s_j) = s_i sum_j(b_j) over its samples j, where b
    /// are pixel values and s what the lamps give, is linear in the intensities. Weights are Geman and McClure's. Where
    /// a group has two albedos, each sample has the one that explains it better; misfit is at least a quarter where
    /// that is the rarer one. `ambient`: what ambient light of 1 gives the samples; null: 1.
    FittedIntensities fit(std::span<const ReceivedLight> lamps, uint32_t steps, size_t count,
                          LightChannel channel = LightChannel::kMean, const ReceivedLight& ambient = nullptr) const;

    /// For each highlight how badly a lamp at this place explains it, 0 to 1: from the angle between the normal and the
    /// half vector.
    std::vector<float> unexplained(glm::vec3 place_m) const;

  private:
    std::vector<gpu::LightSample> samples_, highlights_;
    std::vector<uint32_t> places_;  // of the samples
    std::vector<uint32_t> group_;   // of the samples
    uint32_t groups_ = 0;
};

}  // namespace patina
