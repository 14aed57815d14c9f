#pragma once

#include <vector>

#include "engine/vulkan/device.h"
#include "patina/frame.h"

namespace patina {

/// The built-in office in pictures of 160 x 132, along its path at a third of its frame rate.
struct SmallOffice {
    SmallOffice(vulkan::Device& device, uint32_t count);

    SequenceInfo info;
    std::vector<Frame> frames;
};

/// How far a pose is from the true one of a frame.
struct PoseError {
    double translation_m = 0;
    double rotation_degrees = 0;
};
PoseError pose_error(const RigidTransform& found, const Frame& frame);

}  // namespace patina
