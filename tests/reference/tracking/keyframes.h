#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "patina/image.h"

namespace patina::reference {

/// A pixel of the small picture that ferns look at.
struct SmallPixel {
    std::optional<glm::dvec3> color;  ///< square roots of linear values
    std::optional<double> depth_m;
};

/// Means over boxes of the frame, then Gaussian means over what is valid, as add_shrink_frame says. `color`: linear,
/// a = 0 where it is not known.
Image<SmallPixel> small_picture(const Image<float>& depth_m, const Image<glm::vec4>& color);

/// What one fern says of a frame; a test is absent where the picture does not tell.
struct FernCode {
    std::optional<std::array<bool, 3>> color;
    std::optional<bool> depth;
};

/// The share of differing codes among those whose depth both know, by all tests that both know or by the depth's alone;
/// 1 with less than a quarter to compare.
double dissimilarity(std::span<const FernCode> a, std::span<const FernCode> b, bool depth_alone);

}  // namespace patina::reference
