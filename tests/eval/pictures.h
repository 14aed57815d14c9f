#pragma once

#include <cstdint>
#include <random>

#include "patina/image.h"

namespace patina::test {

/// A picture of value(x, y).
template <class Pixel, class Value>
Image<Pixel> picture_of(Extent2D extent, Value value) {
    Image<Pixel> picture(extent);
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) picture.at(x, y) = static_cast<Pixel>(value(x, y));
    }
    return picture;
}

/// Independent values, uniform in [low, high).
inline Image<float> random_picture(Extent2D extent, uint32_t seed, float low = 0, float high = 1) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(low, high);
    return picture_of<float>(extent, [&](uint32_t, uint32_t) { return uniform(generator); });
}

/// 1 with the given probability, else 0; at least one pixel is 1.
inline Image<uint8_t> random_mask(Extent2D extent, uint32_t seed, double probability) {
    std::mt19937 generator(seed);
    std::bernoulli_distribution chosen(probability);
    Image<uint8_t> mask = picture_of<uint8_t>(extent, [&](uint32_t, uint32_t) { return chosen(generator) ? 1 : 0; });
    mask.at(extent.width / 2, extent.height / 2) = 1;
    return mask;
}

}  // namespace patina::test
