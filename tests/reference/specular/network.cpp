#include "tests/reference/specular/network.h"

#include <algorithm>

namespace patina::reference {

Activations convolve(const Activations& in, std::span<const float> weight, std::span<const float> bias, size_t pad,
                     bool relu) {
    Activations out(in.images, in.side + 2 * pad - 2, bias.size());
    const auto side = static_cast<ptrdiff_t>(in.side);
    const auto convolved = [&](size_t image, size_t x, size_t y, size_t o) {
        double sum = bias[o];
        for (size_t tap = 0; tap < 9; ++tap) {
            const auto from_x = static_cast<ptrdiff_t>(x + tap % 3) - static_cast<ptrdiff_t>(pad);
            const auto from_y = static_cast<ptrdiff_t>(y + tap / 3) - static_cast<ptrdiff_t>(pad);
            if (from_x < 0 || from_y < 0 || from_x >= side || from_y >= side) continue;
            for (size_t i = 0; i < in.channels; ++i) {
                sum += double{weight[(o * in.channels + i) * 9 + tap]} *
                       in.at(image, static_cast<size_t>(from_x), static_cast<size_t>(from_y), i);
            }
        }
        return relu ? std::max(sum, 0.0) : sum;
    };
    for (size_t image = 0; image < out.images; ++image) {
        for (size_t y = 0; y < out.side; ++y) {
            for (size_t x = 0; x < out.side; ++x) {
                for (size_t o = 0; o < out.channels; ++o) out.at(image, x, y, o) = convolved(image, x, y, o);
            }
        }
    }
    return out;
}

Activations max_pool(const Activations& in) {
    Activations out(in.images, in.side / 2, in.channels);
    for (size_t image = 0; image < out.images; ++image) {
        for (size_t y = 0; y < out.side; ++y) {
            for (size_t x = 0; x < out.side; ++x) {
                for (size_t c = 0; c < out.channels; ++c) {
                    out.at(image, x, y, c) =
                        std::max({in.at(image, 2 * x, 2 * y, c), in.at(image, 2 * x + 1, 2 * y, c),
                                  in.at(image, 2 * x, 2 * y + 1, c), in.at(image, 2 * x + 1, 2 * y + 1, c)});
                }
            }
        }
    }
    return out;
}

Activations pool_samples(const Activations& in, size_t samples) {
    Activations out(in.images / samples, 1, 2 * in.channels);
    for (size_t segment = 0; segment < out.images; ++segment) {
        for (size_t c = 0; c < in.channels; ++c) {
            double sum = 0, most = in.at(segment * samples, 0, 0, c);
            for (size_t i = 0; i < samples; ++i) {
                const double value = in.at(segment * samples + i, 0, 0, c);
                sum += value;
                most = std::max(most, value);
            }
            out.at(segment, 0, 0, c) = sum / static_cast<double>(samples);
            out.at(segment, 0, 0, in.channels + c) = most;
        }
    }
    return out;
}

Activations connect(const Activations& in, std::span<const float> weight, std::span<const float> bias, bool relu) {
    Activations out(in.images, 1, bias.size());
    for (size_t image = 0; image < out.images; ++image) {
        for (size_t o = 0; o < out.channels; ++o) {
            double sum = bias[o];
            for (size_t i = 0; i < in.channels; ++i) {
                sum += double{weight[o * in.channels + i]} * in.at(image, 0, 0, i);
            }
            out.at(image, 0, 0, o) = relu ? std::max(sum, 0.0) : sum;
        }
    }
    return out;
}

}  // namespace patina::reference
