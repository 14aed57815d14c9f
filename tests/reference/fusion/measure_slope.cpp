#include "tests/reference/fusion/measure_slope.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace patina::reference {

namespace {

/// The mean of the differences to those of the two neighbours along (dx, dy) that belong to the same surface.
std::optional<double> derivative(const Image<float>& depth_m, int x, int y, int dx, int dy, double jump_m) {
    const auto at = [&](int column, int row) -> double {
        if (!depth_m.extent().contains(column, row)) return 0;
        return depth_m.at(static_cast<uint32_t>(column), static_cast<uint32_t>(row));
    };
    double sum = 0;
    int count = 0;
    for (const int side : {-1, 1}) {
        const double neighbor = at(x + side * dx, y + side * dy);
        if (neighbor == 0 || std::abs(neighbor - at(x, y)) > jump_m) continue;
        sum += side * (neighbor - at(x, y));
        ++count;
    }
    if (count == 0) return {};
    return sum / count;
}

bool is_beside_edge(const Image<float>& depth_m, double nearer_m, int x, int y) {
    for (int row = y - 1; row <= y + 1; ++row) {
        for (int column = x - 1; column <= x + 1; ++column) {
            if (!depth_m.extent().contains(column, row)) continue;
            const float there = depth_m.at(static_cast<uint32_t>(column), static_cast<uint32_t>(row));
            if (there > 0 && double{there} < nearer_m) return true;
        }
    }
    return false;
}

Slope slope_at(const Image<float>& depth_m, const Intrinsics& camera, const SlopeJump& jump, int x, int y) {
    const double z = depth_m.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
    if (z == 0) return {};
    const double jump_m = jump.floor_m + jump.relative * z;
    const auto in_x = derivative(depth_m, x, y, 1, 0, jump_m), in_y = derivative(depth_m, x, y, 0, 1, jump_m);
    if (!in_x || !in_y) return {};
    // The tangents of the surface (X, Y, Z)(u, v) with X = (u - cx) / fx Z span the plane.
    const glm::dvec3 ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
    const glm::dvec3 along_u = ray * *in_x + glm::dvec3(z / camera.fx, 0, 0);
    const glm::dvec3 along_v = ray * *in_y + glm::dvec3(0, z / camera.fy, 0);
    const glm::dvec3 normal = glm::normalize(glm::cross(along_u, along_v));
    return {{*in_x, *in_y}, std::abs(glm::dot(normal, ray)), is_beside_edge(depth_m, z - jump_m, x, y)};
}

}  // namespace

Image<Slope> measure_slope(const Image<float>& depth_m, const Intrinsics& camera, const SlopeJump& jump) {
    Image<Slope> slopes(depth_m.extent());
    for (uint32_t y = 0; y < depth_m.extent().height; ++y) {
        for (uint32_t x = 0; x < depth_m.extent().width; ++x) {
            slopes.at(x, y) = slope_at(depth_m, camera, jump, static_cast<int>(x), static_cast<int>(y));
        }
    }
    return slopes;
}

Slope rounded(const Slope& slope) {
    constexpr double kLargest = 0.064;
    const auto per_px = [&](double value) {
        return std::round(std::clamp(value, -kLargest, kLargest) / kLargest * 1023) / 1023 * kLargest;
    };
    return {{per_px(slope.depth_per_px.x), per_px(slope.depth_per_px.y)},
            std::round(std::min(slope.plane_factor, 1.0) * 511) / 511,
            slope.beside_edge};
}

}  // namespace patina::reference
