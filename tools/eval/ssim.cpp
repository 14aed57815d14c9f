#include "tools/eval/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace patina::eval {
namespace {

constexpr size_t kRadius = 5;
constexpr size_t kTaps = 2 * kRadius + 1;
constexpr double kSigma_px = 1.5;
constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;
// Pixels blurred at a time: a fixed count makes the compiler use vector instructions.
constexpr size_t kBlock = 8;

std::array<double, kTaps> gaussian() {
    std::array<double, kTaps> weights;
    double sum = 0;
    for (size_t i = 0; i < kTaps; ++i) {
        const double x = (static_cast<double>(i) - kRadius) / kSigma_px;
        sum += weights[i] = std::exp(-0.5 * x * x);
    }
    for (double& weight : weights) weight /= sum;
    return weights;
}

// Zeros beside a row, so that windows and blocks may reach over its ends: a window starts kRadius before a pixel, and
// the last block ends kRadius + kBlock behind one.
constexpr size_t kPadding = kRadius + kBlock;

/// A picture in double precision, since the variance is the small difference of large sums.
class Plane {
  public:
    explicit Plane(Extent2D extent)
        : extent_(extent), stride_(extent.width + 2 * kPadding), values_(stride_ * extent.height) {}

    Extent2D extent() const { return extent_; }
    size_t stride() const { return stride_; }
    double* row(size_t y) { return values_.data() + y * stride_ + kPadding; }
    const double* row(size_t y) const { return values_.data() + y * stride_ + kPadding; }

  private:
    Extent2D extent_;
    size_t stride_;
    std::vector<double> values_;
};

/// Weighted sums of kTaps neighbours, `step` values apart, for kBlock values at a time; `first` is the first neighbour.
void sum_block(const double* first, size_t step, std::span<const double> weights, double* out) {
    std::array<double, kBlock> sums{};
    for (size_t tap = 0; tap < weights.size(); ++tap) {
        const double* values = first + tap * step;
        for (size_t i = 0; i < kBlock; ++i) sums[i] += weights[tap] * values[i];
    }
    std::copy(sums.begin(), sums.end(), out);
}

/// The columns of a row that hold mask pixels, end exclusive.
struct Columns {
    size_t begin = 0;
    size_t end = 0;
};

/// Blurs planes around the pixels of a mask; elsewhere the result is meaningless.
class Window {
  public:
    explicit Window(const Image<uint8_t>& mask) : extent_(mask.extent()), columns_(mask.extent().height) {
        for (size_t y = 0; y < columns_.size(); ++y) {
            const auto row = mask.pixels().begin() + static_cast<std::ptrdiff_t>(y * extent_.width);
            const auto end = row + extent_.width;
            const auto first = std::find(row, end, uint8_t{1});
            if (first == end) continue;
            const auto last = std::find(std::reverse_iterator(end), std::reverse_iterator(first), uint8_t{1});
            columns_[y] = {static_cast<size_t>(first - row), static_cast<size_t>(last.base() - row)};
        }
    }

    /// The Gaussian-weighted sums of `in` around each pixel of the mask.
    Plane blur(const Plane& in) const {
        Plane out(extent_), line({extent_.width, 1});
        for (size_t y = 0; y < extent_.height; ++y) {
            const auto [begin, end] = columns_[y];
            if (begin == end) continue;
            const size_t top = y - std::min(y, kRadius);
            const size_t bottom = std::min<size_t>(y + kRadius, extent_.height - 1);
            const auto weights = std::span(weights_).subspan(top + kRadius - y, bottom - top + 1);
            // Counted from kRadius left of the row, so that no index is negative.
            const double* above = in.row(top) - kRadius;
            double* sums = line.row(0) - kRadius;
            for (size_t i = begin; i < end + 2 * kRadius; i += kBlock)
                sum_block(above + i, in.stride(), weights, sums + i);
            for (size_t x = begin; x < end; x += kBlock) sum_block(sums + x, 1, weights_, out.row(y) + x);
        }
        return out;
    }

  private:
    Extent2D extent_;
    std::vector<Columns> columns_;
    std::array<double, kTaps> weights_ = gaussian();
};

/// Calls use(x, y, index) for each pixel of a mask.
template <class Use>
void for_each_pixel(const Image<uint8_t>& mask, Use use) {
    size_t index = 0;
    for (uint32_t y = 0; y < mask.extent().height; ++y) {
        for (uint32_t x = 0; x < mask.extent().width; ++x, ++index) {
            if (mask.pixels()[index]) use(x, y, index);
        }
    }
}

/// value(index) at the pixels of a mask, 0 elsewhere.
template <class Value>
Plane masked(const Image<uint8_t>& mask, Value value) {
    Plane plane(mask.extent());
    for_each_pixel(mask, [&](uint32_t x, uint32_t y, size_t index) { plane.row(y)[x] = value(index); });
    return plane;
}

/// A picture's window sums over one mask.
struct Moments {
    Plane first;   ///< of the values
    Plane second;  ///< of their squares
};

Moments moments(const Window& window, const Image<uint8_t>& mask, const Image<float>& picture) {
    const auto value = [&](size_t i) { return static_cast<double>(picture.pixels()[i]); };
    return {window.blur(masked(mask, value)), window.blur(masked(mask, [&](size_t i) { return value(i) * value(i); }))};
}

/// The sum of Wang's index over a mask's pixels; `weight` is the share of each window inside the mask.
double sum_index(const Image<uint8_t>& mask, const Plane& weight, const Moments& x, const Moments& y, const Plane& xy) {
    double sum = 0;
    for_each_pixel(mask, [&](uint32_t column, uint32_t row, size_t) {
        const auto mean = [&](const Plane& sums) { return sums.row(row)[column] / weight.row(row)[column]; };
        const double mean_x = mean(x.first), mean_y = mean(y.first);
        const double variance_x = mean(x.second) - mean_x * mean_x, variance_y = mean(y.second) - mean_y * mean_y;
        const double covariance = mean(xy) - mean_x * mean_y;
        sum += (2 * mean_x * mean_y + kC1) * (2 * covariance + kC2) /
               ((mean_x * mean_x + mean_y * mean_y + kC1) * (variance_x + variance_y + kC2));
    });
    return sum;
}

}  // namespace

SsimScores ssim(std::span<const Image<float>> truth, std::span<const Image<float>> run, const Image<uint8_t>& region,
                const Image<uint8_t>& filled) {
    const auto region_px = static_cast<double>(std::count(region.pixels().begin(), region.pixels().end(), 1));
    const auto filled_px = static_cast<double>(std::count(filled.pixels().begin(), filled.pixels().end(), 1));
    const Window window(region);
    const auto one = [](size_t) { return 1.0; };
    const Plane region_weight = window.blur(masked(region, one)), filled_weight = window.blur(masked(filled, one));
    double region_sum = 0, filled_sum = 0;
    for (size_t channel = 0; channel < truth.size(); ++channel) {
        const Image<float>&x = truth[channel], &y = run[channel];
        // Unfilled pixels being 0, the sums that involve the run are the same for both ways of counting.
        const Moments run_moments = moments(window, filled, y);
        const Plane products =
            window.blur(masked(filled, [&](size_t i) { return static_cast<double>(x.pixels()[i]) * y.pixels()[i]; }));
        const Moments truth_moments = moments(window, region, x);
        region_sum += sum_index(region, region_weight, truth_moments, run_moments, products);
        if (filled_px < region_px) {
            filled_sum += sum_index(filled, filled_weight, moments(window, filled, x), run_moments, products);
        }
    }
    const auto channels = static_cast<double>(truth.size());
    SsimScores scores;
    scores.all = region_sum / (region_px * channels);
    if (filled_px == region_px)
        scores.filled = scores.all;
    else if (filled_px > 0)
        scores.filled = filled_sum / (filled_px * channels);
    return scores;
}

}  // namespace patina::eval
