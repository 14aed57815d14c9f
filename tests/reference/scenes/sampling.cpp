#include "tests/reference/scenes/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace patina::reference {

using std::numbers::pi;

std::array<uint32_t, 4> hash_words(std::array<uint32_t, 4> words) {
    const auto add_products = [&] {
        words[0] += words[1] * words[3];
        words[1] += words[2] * words[0];
        words[2] += words[0] * words[1];
        words[3] += words[1] * words[2];
    };
    for (uint32_t& word : words) word = word * 1664525 + 1013904223;
    add_products();
    for (uint32_t& word : words) word ^= word >> 16;
    add_products();
    return words;
}

glm::dvec2 r2_point(glm::dvec2 shift, uint32_t index) {
    double g = 1.3;  // the real root of g^3 = g + 1, by Newton's method
    for (int i = 0; i < 50; ++i) g -= (g * g * g - g - 1) / (3 * g * g - 1);
    return glm::fract(shift + double(index) * glm::dvec2(1 / g, 1 / (g * g)));
}

glm::dvec3 direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

glm::dvec3 sampled_half_vector(double alpha, glm::dvec2 u) {
    return direction(std::atan(alpha * std::sqrt(-std::log(1 - u.x))), 2 * pi * u.y);
}

double ward_density(double alpha, glm::dvec3 normal, glm::dvec3 to_light, glm::dvec3 to_viewer) {
    if (glm::dot(normal, to_light) <= 0 || glm::dot(normal, to_viewer) <= 0) return 0;
    const glm::dvec3 half_vector = glm::normalize(to_light + to_viewer);
    const double theta_h = std::acos(std::min(1.0, glm::dot(normal, half_vector)));
    const double of_half_vector =
        std::exp(-std::pow(std::tan(theta_h) / alpha, 2)) / (pi * alpha * alpha * std::pow(std::cos(theta_h), 3));
    return of_half_vector / (4 * glm::dot(half_vector, to_viewer));  // Jacobian of the reflection
}

glm::dvec3 ward_albedo(const Ward& material, double theta_viewer, int theta_steps, int phi_steps) {
    const glm::dvec3 normal(0, 0, 1), to_viewer = direction(theta_viewer, 0);
    const double theta_step = pi / 2 / theta_steps, phi_step = 2 * pi / phi_steps;
    glm::dvec3 sum(0);
    for (int i = 0; i < theta_steps; ++i) {
        const double theta = (i + 0.5) * theta_step;
        for (int j = 0; j < phi_steps; ++j)
            sum += ward(material, normal, direction(theta, (j + 0.5) * phi_step), to_viewer) * std::cos(theta) *
                   std::sin(theta);
    }
    return sum * theta_step * phi_step;
}

}  // namespace patina::reference
