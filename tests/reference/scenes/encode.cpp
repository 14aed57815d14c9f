#include "tests/reference/scenes/encode.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace patina::reference {
namespace {

using Words = std::array<uint32_t, 4>;

Words hashed(Words v) {
    for (uint32_t& word : v) word = word * 1664525u + 1013904223u;
    const auto stir = [](Words w) {
        w[0] += w[1] * w[3];
        w[1] += w[2] * w[0];
        w[2] += w[0] * w[1];
        w[3] += w[1] * w[2];
        return w;
    };
    v = stir(v);
    for (uint32_t& word : v) word ^= word >> 16;
    return stir(v);
}

/// Four numbers in [0, 1) for one use at one pixel.
std::array<double, 4> numbers_of(const scenes::NoiseKey& key, uint32_t x, uint32_t y, uint32_t use) {
    const auto low = static_cast<uint32_t>(key.seed), high = static_cast<uint32_t>(key.seed >> 32);
    const Words stream = hashed({low, high, key.frame, x + 65536 * y});
    const Words words = hashed({stream[0], stream[1], 0, use});
    std::array<double, 4> numbers{};
    for (size_t i = 0; i < 4; ++i) numbers[i] = std::floor(words[i] / 256.0) / 16777216.0;
    return numbers;
}

struct Gaussians {
    double cosine, sine;
};

Gaussians gaussians(double a, double b) {
    const double radius = std::sqrt(-2 * std::log(1 - a)), angle = 2 * std::numbers::pi * b;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// The neighbours' depth that is farthest from a pixel's own, of those more than 3 % away; its own if there is none.
double across_edge_m(const Image<float>& depth_m, int x, int y) {
    const double own = depth_m.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
    double farthest = own;
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
        if (!depth_m.extent().contains(x + dx, y + dy)) continue;
        const double other = depth_m.at(static_cast<uint32_t>(x + dx), static_cast<uint32_t>(y + dy));
        if (other <= 0 || std::max(own, other) <= 1.03 * std::min(own, other)) continue;
        if (std::abs(other - own) > std::abs(farthest - own)) farthest = other;
    }
    return farthest;
}

}  // namespace

Image<double> read_depth_m(const Image<float>& depth_m, const scenes::SensorNoise& noise, const scenes::NoiseKey& key) {
    Image<double> read_m(depth_m.extent(), 0.0);
    for (uint32_t y = 0; y < depth_m.extent().height; ++y) {
        for (uint32_t x = 0; x < depth_m.extent().width; ++x) {
            double z = depth_m.at(x, y);
            if (z <= 0) continue;
            const auto numbers = numbers_of(key, x, y, 0x6e000000);
            if (numbers[0] < noise.flying_pixels) {
                const double other = across_edge_m(depth_m, static_cast<int>(x), static_cast<int>(y));
                z = (1 - numbers[1]) * z + numbers[1] * other;
            }
            const double sigma =
                noise.depth_constant_m + noise.depth_quadratic_per_m * std::pow(z - noise.depth_offset_m, 2);
            read_m.at(x, y) = z + sigma * gaussians(numbers[2], numbers[3]).cosine;
        }
    }
    return read_m;
}

Image<glm::dvec3> expose_color(const Image<glm::vec4>& radiance, double exposure, const scenes::SensorNoise& noise,
                               const scenes::NoiseKey& key) {
    Image<glm::dvec3> linear(radiance.extent());
    for (uint32_t y = 0; y < radiance.extent().height; ++y) {
        for (uint32_t x = 0; x < radiance.extent().width; ++x) {
            const auto numbers = numbers_of(key, x, y, 0x6e000001);
            const Gaussians first = gaussians(numbers[0], numbers[1]);
            const std::array<double, 3> draws{first.cosine, first.sine, gaussians(numbers[2], numbers[3]).cosine};
            for (int c = 0; c < 3; ++c) {
                const double value = exposure * radiance.at(x, y)[c];
                const double variance = noise.color_read * noise.color_read + noise.color_shot * value;
                linear.at(x, y)[c] = std::max(0.0, value + std::sqrt(variance) * draws[static_cast<size_t>(c)]);
            }
        }
    }
    return linear;
}

}  // namespace patina::reference
