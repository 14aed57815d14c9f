#include "cameras/kinect2_capture.h"

#include <algorithm>
#include <utility>

namespace patina::cameras {

using sensor::RecordedFrame;

Kinect2Capture::Kinect2Capture(std::unique_ptr<sensor::kinect2::Transport> transport) : device_(std::move(transport)) {
    device_.start();
    sequence_ = kinect2_sequence(device_.pages(), device_.name());
}

Kinect2Capture::~Kinect2Capture() { stop(); }

void Kinect2Capture::fix_exposure(const sensor::kinect2::ManualExposure& exposure) {
    device_.set_white_balance(device_.white_balance());
    device_.set_exposure(exposure);
}

std::optional<RawReading> Kinect2Capture::next() {
    if (!thread_.joinable()) {
        lost_before_ = lost();
        device_.forget_waiting();  // they are as old as the wait for this call
        thread_ = std::jthread([this] { run(); });
    }
    return newest_.take();
}

void Kinect2Capture::stop() {
    {
        const std::lock_guard lock(tap_mutex_);
        stopped_ = true;
    }
    newest_.end();
    device_.interrupt();
}

double Kinect2Capture::now_s() const {
    const std::lock_guard lock(clock_mutex_);
    return origin_ ? std::chrono::duration<double>(Clock::now() - *origin_).count() : 0;
}

sensor::LiveCounts Kinect2Capture::counts() const {
    sensor::LiveCounts counts = newest_.counts();
    const uint64_t before = lost_before_;
    counts.lost = before == kNotAsked ? 0 : lost() - before;
    return counts;
}

uint64_t Kinect2Capture::lost() const {
    const sensor::kinect2::StreamStatistics statistics = device_.statistics();
    return statistics.infrared.lost_frames + statistics.unpaired_infrared + statistics.dropped_frames;
}

void Kinect2Capture::run() {
    std::exception_ptr failure;
    try {
        sensor::kinect2::RawFrame raw;
        while (device_.next(raw) && hand_over(packer_.pack(std::move(raw)))) raw = {};
    } catch (...) {
        failure = std::current_exception();
    }
    newest_.end(failure);
}

void Kinect2Capture::note_time(double timestamp_s) {
    const auto since = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timestamp_s));
    const Clock::time_point origin = Clock::now() - since;
    const std::lock_guard lock(clock_mutex_);
    origin_ = std::min(origin_.value_or(origin), origin);
}

/// False once nobody takes frames any more.
bool Kinect2Capture::hand_over(RecordedFrame frame) {
    const std::lock_guard lock(tap_mutex_);  // what the tap has seen is counted as captured
    if (stopped_) return false;
    note_time(frame.timestamp_s);
    if (tap_) tap_(frame);
    newest_.put(std::move(frame));
    return true;
}

}  // namespace patina::cameras
