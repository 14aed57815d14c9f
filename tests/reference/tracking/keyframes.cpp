#include "tests/reference/tracking/keyframes.h"

#include <algorithm>
#include <cmath>

namespace patina::reference {

namespace {

constexpr Extent2D kSmall{40, 30};
constexpr int kReach = 7;
constexpr double kSigma = 2.5;

/// Where box i of n over `size` pixels begins and ends; never empty.
std::pair<uint32_t, uint32_t> range_of(uint32_t i, uint32_t n, uint32_t size) {
    const uint32_t begin = i * size / n;
    return {begin, std::max((i + 1) * size / n, begin + 1)};
}

/// The mean over a box of those values that there are, if a quarter is.
template <class Value, class Get>
std::optional<Value> box_mean(uint32_t x, uint32_t y, Extent2D extent, Get get) {
    const auto [x0, x1] = range_of(x, kSmall.width, extent.width);
    const auto [y0, y1] = range_of(y, kSmall.height, extent.height);
    Value sum(0);
    double count = 0;
    for (uint32_t row = y0; row < y1; ++row) {
        for (uint32_t column = x0; column < x1; ++column) {
            if (const std::optional<Value> value = get(column, row)) {
                sum += *value;
                ++count;
            }
        }
    }
    if (count == 0 || count < 0.25 * (x1 - x0) * (y1 - y0)) return std::nullopt;
    return sum / count;
}

template <class Value, class Get>
std::optional<Value> gaussian_mean(int x, int y, Get get) {
    Value sum(0);
    double known = 0, whole = 0;
    for (int dy = -kReach; dy <= kReach; ++dy) {
        for (int dx = -kReach; dx <= kReach; ++dx) {
            const int column = x + dx, row = y + dy;
            if (column < 0 || row < 0 || column >= int(kSmall.width) || row >= int(kSmall.height)) continue;
            const double weight = std::exp(-(dx * dx + dy * dy) / (2 * kSigma * kSigma));
            whole += weight;
            if (const auto& value = get(uint32_t(column), uint32_t(row))) {
                sum += weight * *value;
                known += weight;
            }
        }
    }
    if (known < 0.5 * whole) return std::nullopt;
    return sum / known;
}

}  // namespace

Image<SmallPixel> small_picture(const Image<float>& depth_m, const Image<glm::vec4>& color) {
    Image<SmallPixel> boxes(kSmall), smooth(kSmall);
    for (uint32_t y = 0; y < kSmall.height; ++y) {
        for (uint32_t x = 0; x < kSmall.width; ++x) {
            boxes.at(x, y).depth_m = box_mean<double>(x, y, depth_m.extent(), [&](uint32_t column, uint32_t row) {
                const double depth = depth_m.at(column, row);
                return depth > 0 ? std::optional(depth) : std::nullopt;
            });
            const auto linear = box_mean<glm::dvec3>(x, y, color.extent(), [&](uint32_t column, uint32_t row) {
                const glm::dvec4 pixel(color.at(column, row));
                return pixel.a > 0 ? std::optional(glm::dvec3(pixel)) : std::nullopt;
            });
            if (linear) boxes.at(x, y).color = glm::sqrt(*linear);
        }
    }
    for (int y = 0; y < int(kSmall.height); ++y) {
        for (int x = 0; x < int(kSmall.width); ++x) {
            SmallPixel& pixel = smooth.at(uint32_t(x), uint32_t(y));
            pixel.depth_m = gaussian_mean<double>(
                x, y, [&](uint32_t column, uint32_t row) { return boxes.at(column, row).depth_m; });
            pixel.color = gaussian_mean<glm::dvec3>(
                x, y, [&](uint32_t column, uint32_t row) { return boxes.at(column, row).color; });
        }
    }
    return smooth;
}

double dissimilarity(std::span<const FernCode> a, std::span<const FernCode> b, bool depth_alone) {
    size_t compared = 0, different = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        if (!a[i].depth || !b[i].depth) continue;
        ++compared;
        const bool colored = !depth_alone && a[i].color && b[i].color;
        if (a[i].depth != b[i].depth || (colored && a[i].color != b[i].color)) ++different;
    }
    if (4 * compared < a.size()) return 1;
    return double(different) / double(compared);
}

}  // namespace patina::reference
