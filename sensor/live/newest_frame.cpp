#include "sensor/live/newest_frame.h"

#include <utility>

namespace patina::sensor {

void NewestFrame::put(Reading reading) {
    {
        const std::lock_guard lock(mutex_);
        if (ended_) return;
        ++counts_.captured;
        if (frame_) {
            before_.push_back({frame_->index, "dropped: a newer frame came before it was asked for", true});
            frame_.reset();
            ++counts_.dropped;
        }
        if (auto* skipped = std::get_if<Skipped>(&reading)) {
            before_.push_back(std::move(*skipped));
            ++counts_.damaged;
        } else {
            frame_ = std::get<Frame>(std::move(reading));
        }
    }
    changed_.notify_all();
}

void NewestFrame::end(std::exception_ptr failure) {
    {
        const std::lock_guard lock(mutex_);
        if (ended_) return;
        ended_ = true;
        failure_ = std::move(failure);
    }
    changed_.notify_all();
}

std::optional<Reading> NewestFrame::take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !before_.empty() || frame_ || ended_; });
    if (!before_.empty()) {
        Skipped skipped = std::move(before_.front());
        before_.pop_front();
        return skipped;
    }
    if (frame_) {
        ++counts_.delivered;
        std::optional<Reading> reading = std::move(*frame_);
        frame_.reset();
        return reading;
    }
    if (failure_) std::rethrow_exception(failure_);
    return std::nullopt;
}

LiveCounts NewestFrame::counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
}

}  // namespace patina::sensor
