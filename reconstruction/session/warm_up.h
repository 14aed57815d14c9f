#pragma once

#include <functional>

#include "engine/vulkan/device.h"
#include "patina/frame.h"
#include "reconstruction/pipeline.h"
#include "reconstruction/session/find_lights.h"

namespace patina {

/// Lets the device build what frames of a camera need before the first one is there, which takes seconds: fuses some
/// frames of a made-up corner of a room into a pipeline that is thrown away, and looks at it. A camera that moves
/// meanwhile would be lost. What later frames alone need, such as relocalisation, is built when it is needed. Ends
/// early once `stop` says so. Throws Error as Pipeline does.
void warm_up(vulkan::Device& device, const ReconstructionSettings& settings, const SequenceInfo& info,
             const Illumination& illumination, const std::function<bool()>& stop);

}  // namespace patina
