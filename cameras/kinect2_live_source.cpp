#include "cameras/kinect2_live_source.h"

#include <utility>

namespace patina::cameras {

Kinect2LiveSource::Kinect2LiveSource(vulkan::Device& device, std::shared_ptr<RawCapture> capture)
    : capture_(std::move(capture)),
      decoder_([&device]() -> vulkan::Device& { return device; }, capture_->sequence(), capture_->name()) {
    decoder_.prepare();  // a camera does not wait
}

std::optional<Reading> Kinect2LiveSource::next() {
    auto taken = capture_->next();
    if (!taken) return std::nullopt;
    if (auto* skipped = std::get_if<Skipped>(&*taken)) return std::move(*skipped);
    const auto& recorded = std::get<sensor::RecordedFrame>(*taken);
    Frame frame;
    frame.index = recorded.index;
    frame.timestamp_s = recorded.timestamp_s;
    frame.exposure = recorded.exposure;
    frame.world_from_camera = recorded.world_from_camera;
    frame.pose_defect = recorded.pose_defect;
    try {
        decoder_.decode(recorded, frame);
    } catch (const sensor::DamagedFrame& error) {
        return Skipped{recorded.index, error.what()};
    }
    return frame;
}

}  // namespace patina::cameras
