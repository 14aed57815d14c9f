#pragma once

#include "engine/graph/frame_graph.h"
#include "patina/camera.h"

namespace patina {

/// One level of a pyramid of the frame (r32ui) or of the model (rgba32ui), packed as
/// shaders/lib/tracking/track_pixels.glsl says, and the pinhole camera that would have taken it.
struct TrackLevel {
    graph::ImageId pixels;
    Intrinsics camera;
};

/// Which readings beside each other lie on one surface: those whose depths differ by at most floor_m + slope z, per
/// pixel of the finest level. Between neighbouring pixels a surface inclined by 75 degrees changes by 1 % of its depth
/// at Kinect-like focal lengths.
struct TrackJump {
    float floor_m = 0.01f;
    float slope = 0.015f;
};

/// The camera of the next coarser level, whose pixels are 2 x 2 of `camera`'s; an odd last row or column is left out.
Intrinsics halved(const Intrinsics& camera);

}  // namespace patina
