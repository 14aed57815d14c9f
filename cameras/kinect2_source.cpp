#include "cameras/kinect2_source.h"

#include <utility>

namespace patina::cameras {

namespace {

Exposure exposure_of(const sensor::kinect2::RawFrame& raw) {
    Exposure exposure;
    if (raw.color_exposure_ms > 0) exposure.exposure_s = 0.001 * raw.color_exposure_ms;
    if (raw.color_gain > 0) exposure.gain = raw.color_gain;
    return exposure;
}

}  // namespace

Kinect2Source::Kinect2Source(vulkan::Device& device, const sensor::kinect2::Calibration& calibration,
                             const std::string& name, NextRaw next_raw, const kinect2::DecodeSettings& settings)
    : decoder_(device, camera_model(calibration), {settings, false}),
      info_(decoder_.info(name)),
      next_raw_(std::move(next_raw)) {}

std::optional<Reading> Kinect2Source::next() {
    const std::optional<sensor::kinect2::RawFrame> raw = next_raw_();
    if (!raw) return std::nullopt;
    Frame frame;
    frame.index = index_++;
    frame.timestamp_s = seconds_at(raw->timestamp);
    frame.exposure = exposure_of(*raw);
    try {
        Kinect2Pictures pictures = decoder_.decode(*raw, text(info_.name, " frame ", frame.index));
        frame.color = std::move(pictures.color);
        frame.depth = std::move(pictures.depth_m);
    } catch (const DamagedFrame& error) {
        return Skipped{frame.index, error.what()};
    }
    return frame;
}

double Kinect2Source::seconds_at(uint32_t ticks) {
    const uint32_t step = ticks - last_ticks_.value_or(ticks);
    if (step < 1u << 31) ticks_ += step;  // a larger one is a step back
    last_ticks_ = ticks;
    return static_cast<double>(ticks_) * sensor::kinect2::kSecondsPerTick;
}

}  // namespace patina::cameras
