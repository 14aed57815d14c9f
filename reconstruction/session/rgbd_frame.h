#pragma once

#include "patina/frame.h"
#include "reconstruction/pipeline.h"

namespace patina {

/// A source's frame as a reconstruction takes it. Borrows the frame's pixels. The frame has a pose.
RgbdFrame to_rgbd(const SequenceInfo& info, const Frame& frame);

/// Of the time since the frame before, taken at `before_s`, the share in which the colour camera's shutter was open.
/// Where the exposure is not known, half a frame's time is assumed; 0 where the sequence has no motion blur.
float shutter_share(const SequenceInfo& info, const Frame& frame, double before_s);

/// Whether a frame is kept out of the model where every so many-th is, from the `every`-th on; 0: none.
constexpr bool is_held_out(uint32_t index, uint32_t every) { return every > 0 && index % every == every - 1; }

}  // namespace patina
