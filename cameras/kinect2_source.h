#pragma once

#include <functional>
#include <optional>
#include <string>

#include "cameras/kinect2_decoder.h"
#include "patina/source.h"

namespace patina::cameras {

/// A Kinect v2's raw frames, live or recorded, as a source of decoded ones.
class Kinect2Source : public Source {
  public:
    /// The next raw frame; empty after the last one. May wait.
    using NextRaw = std::function<std::optional<sensor::kinect2::RawFrame>()>;

    /// `name` is the camera or the recording. Throws Error as Kinect2Decoder. `device` outlives it.
    Kinect2Source(vulkan::Device& device, const sensor::kinect2::Calibration& calibration, const std::string& name,
                  NextRaw next_raw, const kinect2::DecodeSettings& settings = {});

    const SequenceInfo& info() const override { return info_; }

    /// A frame that cannot be decoded is skipped. Times count from the first raw frame.
    std::optional<Reading> next() override;

    const FittedColorCamera& color_camera() const { return decoder_.color_camera(); }

  private:
    /// Seconds since the first raw frame; the device's clock may wrap between two.
    double seconds_at(uint32_t ticks);

    Kinect2Decoder decoder_;
    SequenceInfo info_;
    NextRaw next_raw_;
    uint32_t index_ = 0;
    std::optional<uint32_t> last_ticks_;
    uint64_t ticks_ = 0;  ///< since the first raw frame
};

}  // namespace patina::cameras
