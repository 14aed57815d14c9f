#pragma once

#include <vector>

#include "engine/vulkan/device.h"
#include "patina/frame.h"
#include "patina/source.h"

namespace patina {

/// The built-in office in pictures of 160 x 132, along its path at a third of its frame rate.
struct SmallOffice {
    SmallOffice(vulkan::Device& device, uint32_t count);

    SequenceInfo info;
    std::vector<Frame> frames;
};

/// Some of its frames as a recording of their own, at its frame rate.
class ChosenFrames : public Source {
  public:
    /// The office must outlive this.
    ChosenFrames(const SmallOffice& office, std::vector<uint32_t> indices, bool with_poses);

    const SequenceInfo& info() const override { return info_; }
    std::optional<Reading> next() override;

  private:
    const SmallOffice& office_;
    SequenceInfo info_;
    std::vector<uint32_t> indices_;
    uint32_t next_ = 0;
};

/// The indices `first` to `last`, forwards or backwards.
std::vector<uint32_t> from_to(uint32_t first, uint32_t last);

/// How far a pose is from the true one of a frame.
struct PoseError {
    double translation_m = 0;
    double rotation_degrees = 0;
};
PoseError pose_error(const RigidTransform& found, const Frame& frame);

}  // namespace patina
