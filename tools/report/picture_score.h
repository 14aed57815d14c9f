#pragma once

#include <span>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina {

/// How near a predicted picture is to a photograph, over the pixels that the prediction knows.
struct PictureScore {
    double coverage = 0;        ///< share of the picture's pixels that are predicted
    double psnr_linear_db = 0;  ///< of linear values, both clipped to 0..1; of 0 where nothing is predicted
    double psnr_srgb_db = 0;    ///< of the same as 8-bit sRGB
};

/// Scores `predicted` (linear; a > 0 where it is known) against `seen` (linear). PSNRs are at most 100 dB. Throws Error
/// when the extents differ.
PictureScore score_picture(const Image<glm::vec3>& seen, const Image<glm::vec4>& predicted);

/// The gain of each channel that brings `predicted` nearest to `seen`: the median of their ratios over pixels of which
/// both are above 0.015 and below 0.9; 1 where there are fewer than 100.
glm::vec3 gain_between(const Image<glm::vec3>& seen, const Image<glm::vec4>& predicted);

/// The median of each number; zeros for an empty list.
PictureScore median_of(std::span<const PictureScore> scores);

}  // namespace patina
