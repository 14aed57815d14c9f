#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace patina::reference {

/// Images with several channels.
struct Activations {
    size_t images = 0;
    size_t side = 0;
    size_t channels = 0;
    std::vector<double> values{};  ///< [image][y][x][channel]

    Activations(size_t image_count, size_t side_px, size_t channel_count)
        : images(image_count), side(side_px), channels(channel_count), values(images * side * side * channels) {}
    double& at(size_t image, size_t x, size_t y, size_t channel) {
        return values[((image * side + y) * side + x) * channels + channel];
    }
    double at(size_t image, size_t x, size_t y, size_t channel) const {
        return values[((image * side + y) * side + x) * channels + channel];
    }
};

/// 3 x 3, with `pad` rows and columns of zeros around; weights [out][in][ky][kx], as many outputs as biases.
Activations convolve(const Activations& in, std::span<const float> weight, std::span<const float> bias, size_t pad,
                     bool relu);
/// 2 x 2; an odd last row and column are left out.
Activations max_pool(const Activations& in);
/// Of images of one pixel, every `samples` together: the means of the channels, then their maxima.
Activations pool_samples(const Activations& in, size_t samples);
/// Of images of one pixel; weights [out][in].
Activations connect(const Activations& in, std::span<const float> weight, std::span<const float> bias, bool relu);

}  // namespace patina::reference
