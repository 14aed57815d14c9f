#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

#include "tests/reference/shading/ward.h"

namespace patina::reference {

/// The hash pcg4d of Jarzynski and Olano (2020).
std::array<uint32_t, 4> hash_words(std::array<uint32_t, 4> words);

/// Point `index` of the R2 sequence, shifted by `shift`, both coordinates modulo 1.
glm::dvec2 r2_point(glm::dvec2 shift, uint32_t index);

/// The unit vector at an angle from the z axis and an azimuth from the x axis.
glm::dvec3 direction(double theta, double phi);

/// The half vector that Walter's Eq. 6 and 7 draw for the Ward lobe, in a frame whose z axis is the normal.
glm::dvec3 sampled_half_vector(double alpha, glm::dvec2 u);

/// The density, per steradian, with which the mirror direction about such a half vector falls on `to_light`; from
/// angles. 0 where the light or the viewer is not above the horizon.
double ward_density(double alpha, glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_viewer);

/// The share of the light from one direction that leaves into the hemisphere or, as the BRDF is reciprocal, of a
/// uniform sky's that leaves towards the viewer: the integral of the BRDF times the cosine, by the midpoint rule.
glm::dvec3 ward_albedo(const Ward& material, double theta_viewer, int theta_steps = 1000, int phi_steps = 360);

}  // namespace patina::reference
