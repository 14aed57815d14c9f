#pragma once

#include "passes/reconstruction.h"
#include "sensor/frame.h"

namespace patina::tools {

/// A source's frame as a reconstruction takes it. Borrows the frame's pixels. The frame has a pose.
RgbdFrame to_rgbd(const sensor::SequenceInfo& info, const sensor::Frame& frame);

}  // namespace patina::tools
