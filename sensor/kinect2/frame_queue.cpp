#include "sensor/kinect2/frame_queue.h"

#include <utility>

namespace patina::sensor::kinect2 {

RawFrame FrameQueue::push(RawFrame frame) {
    RawFrame spare;
    {
        const std::lock_guard lock(mutex_);
        frames_.push_back(std::move(frame));
        if (frames_.size() > capacity_) {
            spare = std::move(frames_.front());
            frames_.pop_front();
            ++dropped_;
        } else if (!spare_.empty()) {
            spare = std::move(spare_.back());
            spare_.pop_back();
        }
    }
    changed_.notify_all();
    return spare;
}

void FrameQueue::close(std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    failure_ = std::move(failure);
    changed_.notify_all();
}

void FrameQueue::interrupt() {
    const std::lock_guard lock(mutex_);
    interrupted_ = true;
    changed_.notify_all();
}

FrameQueue::Result FrameQueue::pop(RawFrame& frame, std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience, [&] { return interrupted_ || failure_ || !frames_.empty(); });
    if (interrupted_) return Result::kInterrupted;
    if (frames_.empty()) {
        if (failure_) std::rethrow_exception(failure_);
        return Result::kNothing;
    }
    std::swap(frame, frames_.front());
    spare_.push_back(std::move(frames_.front()));
    frames_.pop_front();
    return Result::kFrame;
}

void FrameQueue::forget() {
    const std::lock_guard lock(mutex_);
    for (RawFrame& frame : frames_) spare_.push_back(std::move(frame));
    frames_.clear();
}

uint64_t FrameQueue::dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
}

}  // namespace patina::sensor::kinect2
