#include "sensor/live/played_source.h"

#include <condition_variable>
#include <mutex>
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

PlayedSource::~PlayedSource() {
    stop();
    thread_.request_stop();
}

std::optional<Reading> PlayedSource::next() {
    if (!thread_.joinable()) thread_ = std::jthread([this](std::stop_token stop) { play(stop); });
    return newest_.take();
}

void PlayedSource::stop() {
    stopped_ = true;
    newest_.end();
}

double PlayedSource::now_s() const {
    if (!has_first_) return 0;
    return first_s_ + std::chrono::duration<double>(Clock::now() - start_).count();
}

void PlayedSource::play(std::stop_token stop) {
    std::exception_ptr failure;
    try {
        while (!stopped_) {
            std::optional<Reading> reading = recording_->next();
            if (!reading) break;
            if (const auto* frame = std::get_if<Frame>(&*reading)) wait_for(frame->timestamp_s, stop);
            if (stopped_) break;
            if (tap_) tap_(*reading);
            newest_.put(*std::move(reading));
        }
    } catch (...) {
        failure = std::current_exception();
    }
    newest_.end(failure);
}

void PlayedSource::wait_for(double timestamp_s, std::stop_token stop) {
    if (!has_first_) {
        start_ = Clock::now();
        first_s_ = timestamp_s;
        has_first_ = true;
        return;
    }
    const auto after = std::chrono::duration<double>(timestamp_s - first_s_);
    std::mutex mutex;
    std::condition_variable_any stopped;
    std::unique_lock lock(mutex);
    stopped.wait_until(lock, stop, start_ + std::chrono::duration_cast<Clock::duration>(after), [] { return false; });
}

}  // namespace patina::sensor
