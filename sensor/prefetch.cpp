#include "sensor/prefetch.h"

#include "engine/core/error.h"

namespace patina::sensor {

PrefetchSource::PrefetchSource(std::unique_ptr<Source> source, size_t capacity)
    : source_(std::move(source)), info_(source_->info()), capacity_(capacity) {
    PATINA_ASSERT(capacity > 0, "capacity ", capacity);
    thread_ = std::jthread([this](std::stop_token stop) { read_ahead(stop); });
}

std::optional<Reading> PrefetchSource::next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !queue_.empty() || ended_; });
    if (queue_.empty()) {
        if (failure_) std::rethrow_exception(failure_);
        return std::nullopt;
    }
    Reading reading = std::move(queue_.front());
    queue_.pop_front();
    lock.unlock();
    changed_.notify_all();
    return reading;
}

void PrefetchSource::read_ahead(std::stop_token stop) {
    std::exception_ptr failure;
    try {
        while (std::optional<Reading> reading = source_->next()) {
            std::unique_lock lock(mutex_);
            if (!changed_.wait(lock, stop, [&] { return queue_.size() < capacity_; })) return;
            queue_.push_back(std::move(*reading));
            lock.unlock();
            changed_.notify_all();
            if (stop.stop_requested()) return;
        }
    } catch (...) {
        failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    failure_ = failure;
    ended_ = true;
    changed_.notify_all();
}

}  // namespace patina::sensor
