#include "tests/reference/reflectance/recolor_surfaces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/reference/lighting/lamp_emission.h"

namespace patina::reference {

glm::dvec3 sent_by(const KnownSurface& surface, const std::vector<Light>& lamps) {
    glm::dvec3 irradiance(0);
    for (size_t i = 0; i < lamps.size(); ++i) {
        const glm::dvec3 off = lamps[i].position_m - surface.point_m;
        const double distance = glm::length(off);
        if (surface.lit[i])
            irradiance += emitted(lamps[i].intensity, lamps[i].axis, off) *
                          std::max(glm::dot(off, surface.normal), 0.0) / std::pow(distance, 3);
    }
    glm::dvec3 kd(0);
    for (int c = 0; c < 3; ++c) {
        // A certainty is 1 / (1 + variance), in units of (0.05)^2; the surface around deviates by 0.015.
        const double own = surface.certainty[c] / std::max(1 - surface.certainty[c], 1e-3);
        const double others = surface.kd_around != glm::dvec3(0) ? std::pow(0.05 / 0.015, 2) : 0;
        if (own + others > 0) kd[c] = (own * surface.kd[c] + others * surface.kd_around[c]) / (own + others);
    }
    return kd * (irradiance / std::numbers::pi + surface.around);
}

}  // namespace patina::reference
