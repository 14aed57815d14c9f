#pragma once

#include <memory>
#include <optional>

#include "cameras/kinect2_capture.h"

namespace patina::cameras {

/// The frames of a Kinect v2 that runs, decoded on the device by the thread that asks for them.
class Kinect2LiveSource : public Source {
  public:
    /// `device` outlives it. Throws Error as Kinect2PayloadDecoder.
    Kinect2LiveSource(vulkan::Device& device, std::shared_ptr<Kinect2Capture> capture);

    const SequenceInfo& info() const override { return capture_->sequence().info; }

    /// As Kinect2Capture::next(). A frame that cannot be decoded is skipped.
    std::optional<Reading> next() override;

  private:
    std::shared_ptr<Kinect2Capture> capture_;
    Kinect2PayloadDecoder decoder_;
};

}  // namespace patina::cameras
