#include "tests/reference/eval/ssim.h"

#include <cmath>
#include <vector>

namespace patina::reference {
namespace {

struct Sample {
    double weight, x, y;
};

std::vector<Sample> window(const Image<float>& x, const Image<float>& y, const Image<uint8_t>& mask, int column,
                           int row) {
    std::vector<Sample> samples;
    double sum = 0;
    for (int v = row - 5; v <= row + 5; ++v) {
        for (int u = column - 5; u <= column + 5; ++u) {
            if (!mask.extent().contains(u, v)) continue;
            const auto pu = static_cast<uint32_t>(u), pv = static_cast<uint32_t>(v);
            if (!mask.at(pu, pv)) continue;
            const double squared = (u - column) * (u - column) + (v - row) * (v - row);
            const double weight = std::exp(-squared / (2 * 1.5 * 1.5));
            samples.push_back({weight, x.at(pu, pv), y.at(pu, pv)});
            sum += weight;
        }
    }
    for (Sample& sample : samples) sample.weight /= sum;
    return samples;
}

double index(const std::vector<Sample>& samples) {
    double mean_x = 0, mean_y = 0;
    for (const Sample& s : samples) {
        mean_x += s.weight * s.x;
        mean_y += s.weight * s.y;
    }
    double variance_x = 0, variance_y = 0, covariance = 0;
    for (const Sample& s : samples) {
        variance_x += s.weight * (s.x - mean_x) * (s.x - mean_x);
        variance_y += s.weight * (s.y - mean_y) * (s.y - mean_y);
        covariance += s.weight * (s.x - mean_x) * (s.y - mean_y);
    }
    const double c1 = 0.0001, c2 = 0.0009;
    return (2 * mean_x * mean_y + c1) * (2 * covariance + c2) /
           ((mean_x * mean_x + mean_y * mean_y + c1) * (variance_x + variance_y + c2));
}

}  // namespace

double ssim(const Image<float>& x, const Image<float>& y, const Image<uint8_t>& mask) {
    double sum = 0;
    int pixels = 0;
    for (uint32_t row = 0; row < mask.extent().height; ++row) {
        for (uint32_t column = 0; column < mask.extent().width; ++column) {
            if (!mask.at(column, row)) continue;
            sum += index(window(x, y, mask, static_cast<int>(column), static_cast<int>(row)));
            ++pixels;
        }
    }
    return sum / pixels;
}

}  // namespace patina::reference
