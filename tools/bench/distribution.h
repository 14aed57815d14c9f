#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace patina::bench {

/// How samples spread; all zero where there are none.
struct Distribution {
    size_t count = 0;
    float min = 0;
    float median = 0;
    float p90 = 0;  ///< nine in ten are at most this
};

inline Distribution distribution(std::vector<float> samples) {
    if (samples.empty()) return {};
    std::sort(samples.begin(), samples.end());
    const size_t count = samples.size();
    return {count, samples.front(), samples[count / 2], samples[(count * 9 + 9) / 10 - 1]};
}

}  // namespace patina::bench
