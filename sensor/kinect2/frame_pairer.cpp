#include "sensor/kinect2/frame_pairer.h"

#include <utility>

#include "sensor/kinect2/sequence.h"

namespace patina::sensor::kinect2 {
namespace {

constexpr int32_t kMostTicksApart = 128;  // 16 ms
/// 200 ms of either stream, three times what colour is later than infrared.
constexpr size_t kMostWaiting = 6;

template <class Frame>
Frame take_back(std::vector<Frame>& spare) {
    if (spare.empty()) return {};
    Frame frame = std::move(spare.back());
    spare.pop_back();
    return frame;
}

}  // namespace

void FramePairer::add(InfraredFrame frame) {
    infrared_.push_back(std::move(frame));
    if (infrared_.size() > kMostWaiting) drop_infrared();
}

void FramePairer::add(ColorFrame frame) {
    color_.push_back(std::move(frame));
    if (color_.size() > kMostWaiting) drop_color();
}

bool FramePairer::next(RawFrame& pair) {
    while (!infrared_.empty() && !color_.empty()) {
        const int32_t apart = distance(infrared_.front().timestamp, color_.front().timestamp);
        if (apart < -kMostTicksApart) {
            drop_color();
        } else if (apart > kMostTicksApart) {
            drop_infrared();
        } else {
            break;
        }
    }
    if (infrared_.empty() || color_.empty()) return false;
    InfraredFrame& infrared = infrared_.front();
    ColorFrame& color = color_.front();
    pair.sequence = infrared.sequence;
    pair.timestamp = infrared.timestamp;
    pair.infrared.swap(infrared.bytes);
    pair.color_sequence = color.sequence;
    pair.color_timestamp = color.timestamp;
    pair.color.swap(color.jpeg);
    pair.color_exposure_ms = color.exposure_ms;
    pair.color_gain = color.gain;
    pair.color_gamma = color.gamma;
    spare_infrared_.push_back(std::move(infrared));
    infrared_.pop_front();
    spare_color_.push_back(std::move(color));
    color_.pop_front();
    return true;
}

void FramePairer::drop_infrared() {
    spare_infrared_.push_back(std::move(infrared_.front()));
    infrared_.pop_front();
    ++unpaired_infrared_;
}

void FramePairer::drop_color() {
    spare_color_.push_back(std::move(color_.front()));
    color_.pop_front();
    ++unpaired_color_;
}

InfraredFrame FramePairer::spare_infrared() { return take_back(spare_infrared_); }

ColorFrame FramePairer::spare_color() { return take_back(spare_color_); }

}  // namespace patina::sensor::kinect2
