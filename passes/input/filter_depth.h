#pragma once

#include "engine/graph/frame_graph.h"

namespace patina {

/// How depth is smoothed. The depth sigma follows a sensor's noise, which grows with the square of the distance z
/// (Khoshelham and Elberink 2012): sigma(z) = max(sigma_floor_m, sigma_linear z + sigma_quadratic z^2). The defaults
/// are two to three times the noise of a Kinect (Nguyen et al. 2012: 0.0012 m + 0.0019 / m (z - 0.4 m)^2) beyond 1.5 m,
/// so that noise is averaged and steps of 0.05 m at 1 m stay; the 0.1 m of VoxelHashing would blur them.
struct DepthFilter {
    float sigma_px = 2.0f;
    float sigma_floor_m = 0.01f;
    float sigma_linear = 0.005f;
    float sigma_quadratic = 0.0025f;  ///< 1 / m
};

/// Bilateral filter over 5 x 5 pixels (Tomasi and Manduchi 1998). `depth_m`: r32f in metres, 0 where there is no
/// reading; such pixels are ignored and stay 0. Returns a new r32f image. Throws Error unless the sigmas are positive.
graph::ImageId add_filter_depth(graph::FrameGraph& frame, graph::ImageId depth_m, const DepthFilter& filter = {});

}  // namespace patina
