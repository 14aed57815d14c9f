#include "tools/record/decode_queue.h"

#include <utility>

#include "engine/core/error.h"

namespace patina::tools {

namespace {

uint64_t bytes_of_raw(const sensor::RecordedFrame& frame) {
    uint64_t bytes = 1;  // without payloads, too, it takes a place
    for (const sensor::Payload& payload : frame.payloads) bytes += payload.content.size();
    return bytes;
}

}  // namespace

DecodeQueue::DecodeQueue(Decode decode, HandOn hand_on, uint64_t most_bytes)
    : decode_(std::move(decode)),
      hand_on_(std::move(hand_on)),
      most_bytes_(most_bytes),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void DecodeQueue::put(const cameras::RawReading& reading) {
    if (const auto* frame = std::get_if<sensor::RecordedFrame>(&reading)) {
        put_frame(*frame);
    } else {
        put_skipped(std::get<Skipped>(reading));
    }
    changed_.notify_all();
}

/// A frame of a Kinect is copied in a millisecond, for which nobody waits: the lock is not held.
void DecodeQueue::put_frame(const sensor::RecordedFrame& frame) {
    if (!reserve(bytes_of_raw(frame)))
        return put_skipped({frame.index, "dropped: too many frames before it waited to be decoded", true});
    std::optional copy(frame);
    const std::lock_guard lock(mutex_);
    if (problem_.empty()) waiting_.push_back({std::move(copy), {}});
}

/// Whether there is room, which is taken then.
bool DecodeQueue::reserve(uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    const bool full = bytes_ > 0 && bytes_ + bytes > most_bytes_;
    dropped_ += full && problem_.empty();
    if (!full) bytes_ += bytes;
    return !full;
}

void DecodeQueue::put_skipped(const Skipped& skipped) {
    const std::lock_guard lock(mutex_);
    if (!problem_.empty()) return;
    if (waiting_.empty()) waiting_.emplace_back();
    waiting_.back().skipped.push(skipped);
}

void DecodeQueue::drain() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return waiting_.empty() || !problem_.empty(); });
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

/// What is next, under the lock; empty where nothing waits any more.
std::optional<cameras::RawReading> DecodeQueue::take() {
    while (!waiting_.empty()) {
        Entry& first = waiting_.front();
        if (std::optional frame = std::exchange(first.frame, std::nullopt)) return *std::move(frame);
        if (std::optional skipped = first.skipped.pop()) return *std::move(skipped);
        waiting_.pop_front();
    }
    return std::nullopt;
}

/// Without the lock. Returns why nothing more can be decoded; empty while it can.
std::string DecodeQueue::process(cameras::RawReading reading) const {
    try {
        if (const auto* frame = std::get_if<sensor::RecordedFrame>(&reading)) reading = decode_(*frame);
        hand_on_(std::move(reading));
        return "";
    } catch (const std::exception& error) {
        return reason_of(error);
    }
}

void DecodeQueue::run(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (changed_.wait(lock, stop, [&] { return !waiting_.empty(); })) {
        if (std::optional<cameras::RawReading> reading = take()) {
            lock.unlock();
            const auto* frame = std::get_if<sensor::RecordedFrame>(&*reading);
            const uint64_t bytes = frame ? bytes_of_raw(*frame) : 0;
            const std::string problem = process(*std::move(reading));
            lock.lock();
            bytes_ -= bytes;
            problem_ = problem;
        }
        if (!problem_.empty()) waiting_.clear();
        changed_.notify_all();
        if (!problem_.empty()) return;
    }
}

}  // namespace patina::tools
