#pragma once

#include <cstdint>
#include <vector>

#include "tools/eval/result.h"

namespace patina::eval {

/// Gathers absolute errors of any number of pixels in fixed memory. Mean and RMSE are exact; the percentiles come from
/// a histogram, whose bins are at most 0.05 % of their value wide: each is its bin's lower edge.
class PixelErrorSum {
  public:
    PixelErrorSum();

    /// Adds an error; it must be at least 0 and finite.
    void add(float error);

    /// The spread so far, covering part of `truth_pixels`. Empty without any error.
    std::optional<PixelErrors> spread(uint64_t truth_pixels) const;

  private:
    double percentile(double share) const;

    std::vector<uint64_t> bins_;
    uint64_t count_ = 0;
    double sum_ = 0;
    double sum_of_squares_ = 0;
};

}  // namespace patina::eval
