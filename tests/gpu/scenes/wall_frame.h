#pragma once

#include "patina/frame.h"

namespace patina {

/// A wall of one colour, 1 m before a camera that rests at the world's origin.
inline Frame wall_frame(const SequenceInfo& info, uint32_t index, SrgbPixel color) {
    Frame frame;
    frame.index = index;
    frame.timestamp_s = index / info.fps;
    frame.depth = Image<uint16_t>(info.depth.extent, 1000);
    frame.color = Image<SrgbPixel>(info.color.extent, color);
    frame.world_from_camera = RigidTransform(1.0);
    return frame;
}

}  // namespace patina
