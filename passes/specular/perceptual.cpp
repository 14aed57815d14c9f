#include "passes/specular/perceptual.h"

#include <cmath>

namespace patina {

namespace {

const glm::dvec3 kWhite(0.95047, 1, 1.08883);  // D65
// Columns: what linear red, green and blue give.
const glm::dmat3 kXyzFromRgb(0.4124564, 0.2126729, 0.0193339, 0.3575761, 0.7151522, 0.1191920, 0.1804375, 0.0721750,
                             0.9503041);
constexpr double kKnee = 6.0 / 29;  // of CIELAB's cube root, which goes on as a straight line

double root(double t) { return t > kKnee * kKnee * kKnee ? std::cbrt(t) : t / (3 * kKnee * kKnee) + 4.0 / 29; }
double cube(double f) { return f > kKnee ? f * f * f : 3 * kKnee * kKnee * (f - 4.0 / 29); }

}  // namespace

Perceptual perceptual_of(const WardParameters& material) {
    const glm::dvec3 t = kXyzFromRgb * material.kd / kWhite;
    const double x = root(t.x), y = root(t.y), z = root(t.z);
    Perceptual w{1.16 * y - 0.16, 5 * (x - y), 2 * (y - z), 0, 0, 0, 1 - material.alpha};
    for (int c = 0; c < 3; ++c) {
        const double half = material.kd[c] / 2;
        w[static_cast<size_t>(3 + c)] = std::cbrt(material.ks[c] + half) - std::cbrt(half);
    }
    return w;
}

WardParameters ward_of(const Perceptual& w) {
    const double y = (w[0] + 0.16) / 1.16;
    const glm::dvec3 t(cube(y + w[1] / 5), cube(y), cube(y - w[2] / 2));
    const glm::dvec3 kd = glm::inverse(kXyzFromRgb) * (t * kWhite);
    WardParameters material{glm::clamp(kd, 0.0, 1.0), {}, std::max(1 - w[6], 0.01)};
    for (int c = 0; c < 3; ++c) {
        const double half = kd[c] / 2, sum = w[static_cast<size_t>(3 + c)] + std::cbrt(half);
        material.ks[c] = std::max(sum * sum * sum - half, 0.0);
    }
    return material;
}

}  // namespace patina
