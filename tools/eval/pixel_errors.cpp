#include "tools/eval/pixel_errors.h"

#include <bit>
#include <cmath>

#include "engine/core/error.h"

namespace patina::eval {
namespace {

// The upper bits of positive floats number bins in rising order, each 2^-11 of its lower edge wide.
constexpr uint32_t kDroppedBits = 12;
constexpr size_t kBins = size_t{1} << (31 - kDroppedBits);

}  // namespace

PixelErrorSum::PixelErrorSum() : bins_(kBins) {}

void PixelErrorSum::add(float error) {
    PATINA_ASSERT(error >= 0 && std::isfinite(error), "error ", error);
    ++bins_[std::bit_cast<uint32_t>(std::abs(error)) >> kDroppedBits];
    ++count_;
    sum_ += error;
    sum_of_squares_ += static_cast<double>(error) * error;
}

std::optional<PixelErrors> PixelErrorSum::spread(uint64_t truth_pixels) const {
    if (count_ == 0) return std::nullopt;
    const auto count = static_cast<double>(count_);
    PixelErrors errors;
    errors.pixels = count_;
    errors.coverage = count / static_cast<double>(truth_pixels);
    errors.median = percentile(0.5);
    errors.mean = sum_ / count;
    errors.p90 = percentile(0.9);
    errors.rmse = std::sqrt(sum_of_squares_ / count);
    return errors;
}

double PixelErrorSum::percentile(double share) const {
    const auto rank = static_cast<uint64_t>(std::ceil(share * static_cast<double>(count_)));
    uint64_t below = 0;
    size_t bin = 0;
    while ((below += bins_[bin]) < rank) ++bin;
    return std::bit_cast<float>(static_cast<uint32_t>(bin << kDroppedBits));
}

}  // namespace patina::eval
