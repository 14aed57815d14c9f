#include "tests/reference/input/filter_depth.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

namespace {

float filtered(const Image<float>& depth_m, const DepthFilter& filter, int x, int y) {
    const auto at = [&](int column, int row) -> double {
        if (!depth_m.extent().contains(column, row)) return 0;
        return depth_m.at(static_cast<uint32_t>(column), static_cast<uint32_t>(row));
    };
    const double center = at(x, y);
    if (center == 0) return 0;
    const double sigma =
        std::max<double>(filter.sigma_floor_m, filter.sigma_linear * center + filter.sigma_quadratic * center * center);
    double weights = 0, sum = 0;
    for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
            const double neighbor = at(x + dx, y + dy);
            if (neighbor == 0) continue;
            const double in_space = (dx * dx + dy * dy) / (2.0 * filter.sigma_px * filter.sigma_px);
            const double in_depth = (neighbor - center) * (neighbor - center) / (2 * sigma * sigma);
            const double weight = std::exp(-in_space) * std::exp(-in_depth);
            weights += weight;
            sum += weight * neighbor;
        }
    }
    return static_cast<float>(sum / weights);
}

}  // namespace

Image<float> filter_depth(const Image<float>& depth_m, const DepthFilter& filter) {
    Image<float> result(depth_m.extent());
    for (uint32_t y = 0; y < depth_m.extent().height; ++y) {
        for (uint32_t x = 0; x < depth_m.extent().width; ++x) {
            result.at(x, y) = filtered(depth_m, filter, static_cast<int>(x), static_cast<int>(y));
        }
    }
    return result;
}

}  // namespace patina::reference
