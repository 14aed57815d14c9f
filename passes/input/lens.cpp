#include "passes/input/lens.h"

#include <algorithm>
#include <cmath>

namespace patina {

namespace {

/// The squared radius at z = 1 up to which the radial distortion r (1 + k1 r^2 + k2 r^4 + k3 r^6) grows with r, at most
/// the picture's farthest corner. Beyond it the polynomial folds back and shows the picture a second time.
double unfolded_radius2(const Intrinsics& camera) {
    const auto [k1, k2, p1, p2, k3] = camera.distortion;
    const double x = std::max(camera.cx, camera.extent.width - 1 - camera.cx) / camera.fx;
    const double y = std::max(camera.cy, camera.extent.height - 1 - camera.cy) / camera.fy;
    const double corner = (x * x + y * y) * 1.001;  // rounding must not lose the corner itself
    constexpr int kSteps = 1000;                    // the corner of a VGA picture is 400 pixels from its centre
    for (int i = 1; i <= kSteps; ++i) {
        const double r2 = corner * i / kSteps;
        if (1 + r2 * (3 * k1 + r2 * (5 * k2 + r2 * 7 * k3)) <= 0) return corner * (i - 1) / kSteps;
    }
    return corner;
}

}  // namespace

gpu::Lens lens_of(const Intrinsics& camera, const char* pass) {
    const auto& k = camera.distortion;
    const bool finite = std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy) &&
                        std::all_of(k.begin(), k.end(), [](double value) { return std::isfinite(value); });
    if (!finite || camera.fx <= 0 || camera.fy <= 0) {
        throw Error("the pass '", pass, "' got a camera without usable intrinsics: fx ", camera.fx, ", fy ", camera.fy,
                    ", cx ", camera.cx, ", cy ", camera.cy, ", distortion ", k[0], " ", k[1], " ", k[2], " ", k[3], " ",
                    k[4]);
    }
    return {glm::vec4(camera.fx, camera.fy, camera.cx, camera.cy),
            glm::vec4(k[0], k[1], k[4], unfolded_radius2(camera)), glm::vec2(k[2], k[3]),
            glm::uvec2(camera.extent.width, camera.extent.height)};
}

}  // namespace patina
