#pragma once

#include <array>

#include <glm/glm.hpp>

namespace patina {

/// Ward's parameters (paper, Eq. 2-4): albedos, linear RGB, and roughness.
struct WardParameters {
    glm::dvec3 kd{0};
    glm::dvec3 ks{0};
    double alpha = 1;
};

/// w = (L, a, b, c_r, c_g, c_b, d), in which equal steps look about equally large (paper, Section 3.6; Pellacini et al.
/// 2000): CIELAB of kd (linear sRGB, D65) over 100, c = cbrt(ks + kd / 2) - cbrt(kd / 2) per channel, d = 1 - alpha.
using Perceptual = std::array<double, 7>;

Perceptual perceptual_of(const WardParameters& material);

/// Its inverse; kd within [0, 1], ks not negative, and alpha at least 0.01.
WardParameters ward_of(const Perceptual& w);

}  // namespace patina
