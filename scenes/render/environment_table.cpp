#include "scenes/render/environment_table.h"

#include <cmath>
#include <numbers>
#include <span>

#include "engine/core/error.h"

namespace patina::scenes {
namespace {

constexpr size_t kMaxCells = size_t{1} << 23;  // times 16 bytes: 128 MiB

void check(const std::string& scene_name, const Image<glm::vec3>& radiance) {
    const Extent2D extent = radiance.extent();
    const auto fail = [&](const auto&... parts) {
        throw Error("scene '", scene_name, "': the environment ", parts...);
    };
    if (extent.area() == 0 || extent.area() > kMaxCells) fail("has ", extent, " pixels, not between 1 and ", kMaxCells);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                const float value = radiance.at(x, y)[c];
                if (!(value >= 0 && std::isfinite(value)))
                    fail("has the radiance ", value, " in pixel (", x, ", ", y,
                         "), which must be finite and not negative");
            }
        }
    }
}

/// Walker's aliases by Vose's method; the weights' mean is 1 and they end as what remains of them.
std::vector<gpu::EnvironmentAlias> make_aliases(std::span<double> weights) {
    std::vector<gpu::EnvironmentAlias> aliases(weights.size());
    std::vector<uint32_t> small, large;
    for (uint32_t i = 0; i < weights.size(); ++i) {
        aliases[i] = {1.0f, i};
        (weights[i] < 1 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const uint32_t poor = small.back(), rich = large.back();
        small.pop_back();
        aliases[poor] = {static_cast<float>(weights[poor]), rich};
        weights[rich] -= 1 - weights[poor];
        if (weights[rich] >= 1) continue;
        large.pop_back();
        small.push_back(rich);
    }
    // Rounding leaves some cells over that lack, or have, next to nothing: they keep the certainty they began with.
    return aliases;
}

}  // namespace

double cell_solid_angle(Extent2D extent, uint32_t row) {
    const double step = std::numbers::pi / extent.height;
    // cos(a) - cos(b) of the row's upper and lower edge, without cancellation.
    const double height = 2 * std::sin((row + 0.5) * step) * std::sin(step / 2);
    return 2 * std::numbers::pi / extent.width * height;
}

EnvironmentTable make_environment_table(const std::string& scene_name, const Image<glm::vec3>& radiance) {
    check(scene_name, radiance);
    const Extent2D extent = radiance.extent();
    double total = 0;
    std::vector<double> weights;
    weights.reserve(extent.area());
    const auto weigh = [&](auto brightness) {
        for (uint32_t y = 0; y < extent.height; ++y)
            for (uint32_t x = 0; x < extent.width; ++x)
                total += weights.emplace_back(brightness(glm::dvec3(radiance.at(x, y))) * cell_solid_angle(extent, y));
    };
    weigh([](glm::dvec3 rgb) { return rgb.r + rgb.g + rgb.b; });
    if (total == 0) {
        weights.clear();
        weigh([](glm::dvec3) { return 1.0; });
    }
    EnvironmentTable table{extent, {}, {}};
    table.cells.reserve(extent.area());
    for (size_t i = 0; i < weights.size(); ++i) {
        const double density = weights[i] / total / cell_solid_angle(extent, static_cast<uint32_t>(i / extent.width));
        table.cells.emplace_back(radiance.pixels()[i], density);
        weights[i] *= static_cast<double>(extent.area()) / total;
    }
    table.aliases = make_aliases(weights);
    return table;
}

}  // namespace patina::scenes
