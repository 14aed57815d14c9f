#include "sensor/live/played_source.h"

#include <algorithm>
#include <utility>

#include "sensor/prefetch.h"

namespace patina::sensor {

namespace {

/// Decoded ahead, so that one frame that takes longer to decode does not come late.
constexpr size_t kDecodedAhead = 8;

}  // namespace

PlayedSource::PlayedSource(std::unique_ptr<Source> recording, ReadingTap tap)
    : recording_(std::make_unique<PrefetchSource>(std::move(recording), kDecodedAhead)),
      tap_(std::move(tap)),
      info_(recording_->info()) {
    info_.frames.reset();
}

PlayedSource::~PlayedSource() { stop(); }

std::optional<Reading> PlayedSource::next() {
    if (!thread_.joinable()) thread_ = std::jthread([this] { play(); });
    return newest_.take();
}

void PlayedSource::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
    }
    changed_.notify_all();
    newest_.end();
}

double PlayedSource::now_s() const {
    const std::lock_guard lock(clock_mutex_);
    return last_ ? last_->timestamp_s + std::chrono::duration<double>(Clock::now() - last_->at).count() : 0;
}

void PlayedSource::play() {
    std::exception_ptr failure;
    try {
        while (std::optional<Reading> reading = recording_->next()) {
            const auto* frame = std::get_if<Frame>(&*reading);
            if (frame && !wait_for(frame->timestamp_s)) break;
            if (!hand_over(*std::move(reading))) break;
        }
    } catch (...) {
        failure = std::current_exception();
    }
    newest_.end(failure);
}

/// When a frame is to come.
PlayedSource::Moment PlayedSource::due(double timestamp_s) {
    const std::lock_guard lock(clock_mutex_);
    Moment moment{timestamp_s, Clock::now()};
    if (last_) {
        const double gap_s = std::clamp(timestamp_s - last_->timestamp_s, 0.0, kLongestGap_s);
        moment.at = last_->at + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(gap_s));
    }
    last_ = moment;
    return moment;
}

/// False once nobody takes frames any more.
bool PlayedSource::wait_for(double timestamp_s) {
    const Moment moment = due(timestamp_s);
    std::unique_lock lock(mutex_);
    changed_.wait_until(lock, moment.at, [&] { return stopped_; });
    return !stopped_;
}

bool PlayedSource::hand_over(Reading reading) {
    const std::lock_guard lock(mutex_);  // what the tap has seen is counted as captured
    if (stopped_) return false;
    if (tap_) tap_(reading);
    newest_.put(std::move(reading));
    return true;
}

}  // namespace patina::sensor
