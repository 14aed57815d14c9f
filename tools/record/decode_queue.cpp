#include "tools/record/decode_queue.h"

#include <utility>

#include "engine/core/error.h"

namespace patina::tools {

namespace {

uint64_t bytes_of_raw(const cameras::RawReading& reading) {
    const auto* frame = std::get_if<sensor::RecordedFrame>(&reading);
    uint64_t bytes = 0;
    if (frame)
        for (const sensor::Payload& payload : frame->payloads) bytes += payload.content.size();
    return bytes;
}

}  // namespace

DecodeQueue::DecodeQueue(Decode decode, HandOn hand_on, uint64_t most_bytes)
    : decode_(std::move(decode)),
      hand_on_(std::move(hand_on)),
      most_bytes_(most_bytes),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void DecodeQueue::put(const cameras::RawReading& reading) {
    const uint64_t bytes = bytes_of_raw(reading);
    {
        const std::lock_guard lock(mutex_);
        if (!problem_.empty()) return;
        if (bytes > 0 && bytes_ > 0 && bytes_ + bytes > most_bytes_) {
            const uint32_t index = std::get<sensor::RecordedFrame>(reading).index;
            waiting_.emplace_back(Skipped{index, "dropped: too many frames before it waited to be decoded", true});
            ++dropped_;
        } else {
            waiting_.push_back(reading);
            bytes_ += bytes;
        }
    }
    changed_.notify_all();
}

void DecodeQueue::drain() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return (waiting_.empty() && !busy_) || !problem_.empty(); });
    if (!problem_.empty()) throw Error(problem_);
}

uint64_t DecodeQueue::dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
}

std::string DecodeQueue::problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
}

void DecodeQueue::run(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (changed_.wait(lock, stop, [&] { return !waiting_.empty(); })) {
        cameras::RawReading reading = std::move(waiting_.front());
        waiting_.pop_front();
        busy_ = true;
        lock.unlock();
        std::string problem;
        const uint64_t bytes = bytes_of_raw(reading);
        try {
            if (const auto* frame = std::get_if<sensor::RecordedFrame>(&reading)) reading = decode_(*frame);
            hand_on_(reading);
        } catch (const std::exception& error) {
            problem = reason_of(error);
        }
        lock.lock();
        busy_ = false;
        bytes_ -= bytes;
        problem_ = problem;
        changed_.notify_all();
        if (!problem_.empty()) return;
    }
}

}  // namespace patina::tools
