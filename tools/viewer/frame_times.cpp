#include "tools/viewer/frame_times.h"

#include <numeric>

namespace patina::tools {

void FrameTimes::fused(double now_s, std::span<const graph::Timing> passes) {
    double sum_ms = 0;
    for (const graph::Timing& pass : passes) {
        size_t& counted = counted_[pass.name];
        for (; counted < pass.samples_ms.size(); ++counted) sum_ms += double{pass.samples_ms[counted]};
    }
    if (last_s_) {
        keep(intervals_ms_, (now_s - *last_s_) * 1000);
        if (!passes.empty()) keep(device_ms_, sum_ms);
    }
    last_s_ = now_s;
}

double FrameTimes::mean(const std::deque<double>& values) {
    return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void FrameTimes::keep(std::deque<double>& values, double value) {
    values.push_back(value);
    if (values.size() > kMeanOf) values.pop_front();
}

}  // namespace patina::tools
