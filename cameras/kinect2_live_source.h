#pragma once

#include <memory>
#include <optional>

#include "cameras/kinect2_recorded.h"
#include "cameras/raw_capture.h"

namespace patina::cameras {

/// The frames of a Kinect v2 that runs, or of a raw recording that plays, decoded on the device by the thread that asks
/// for them: those that are dropped cost nothing.
class Kinect2LiveSource : public Source {
  public:
    /// `device` outlives it. Throws Error as Kinect2PayloadDecoder.
    Kinect2LiveSource(vulkan::Device& device, std::shared_ptr<RawCapture> capture);

    const SequenceInfo& info() const override { return capture_->sequence().info; }

    /// As RawCapture::next(). A frame that cannot be decoded is skipped.
    std::optional<Reading> next() override;

  private:
    std::shared_ptr<RawCapture> capture_;
    Kinect2PayloadDecoder decoder_;
};

}  // namespace patina::cameras
