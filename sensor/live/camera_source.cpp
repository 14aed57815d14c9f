#include "sensor/live/camera_source.h"

#include <exception>
#include <utility>

#include "sensor/live/picture_pairs.h"

namespace patina::sensor {

CameraSource::CameraSource(std::unique_ptr<PictureCamera> camera) : camera_(std::move(camera)) {}

CameraSource::~CameraSource() { stop(); }

std::optional<Reading> CameraSource::next() {
    if (!thread_.joinable() && !stop_.stop_requested()) thread_ = std::jthread([this] { run(stop_.get_token()); });
    return newest_.take();
}

void CameraSource::stop() {
    {
        const std::lock_guard lock(tap_mutex_);
        stopped_ = true;
    }
    stop_.request_stop();
    newest_.end();
}

double CameraSource::now_s() const {
    const std::lock_guard lock(clock_mutex_);
    return origin_ ? std::chrono::duration<double>(Clock::now() - *origin_).count() : 0;
}

void CameraSource::note_time(double timestamp_s) {
    const auto since = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timestamp_s));
    const std::lock_guard lock(clock_mutex_);
    const Clock::time_point origin = Clock::now() - since;
    if (!origin_ || origin < *origin_) origin_ = origin;
}

void CameraSource::run(const std::stop_token& stop) {
    PicturePairs pairs(
        kMostApart_s,
        [this](double timestamp_s, Image<uint16_t> depth, Image<SrgbPixel> color) {
            note_time(timestamp_s);
            Frame frame;
            frame.index = frames_++;
            frame.timestamp_s = timestamp_s;
            frame.depth = std::move(depth);
            frame.color = std::move(color);
            hand_over(std::move(frame));
        },
        [this](std::string reason) {
            hand_over(Skipped{frames_++, std::move(reason)});
        });
    std::exception_ptr failure;
    try {
        camera_->run({[&](double t, Image<uint16_t> picture) { pairs.depth(t, std::move(picture)); },
                      [&](double t, Image<SrgbPixel> picture) { pairs.color(t, std::move(picture)); }},
                     stop);
    } catch (...) {
        failure = std::current_exception();
    }
    newest_.end(failure);
}

void CameraSource::hand_over(Reading reading) {
    const std::lock_guard lock(tap_mutex_);  // what the tap has seen is counted as captured
    if (stopped_) return;
    if (tap_) tap_(reading);
    newest_.put(std::move(reading));
}

}  // namespace patina::sensor
