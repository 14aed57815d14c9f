#pragma once

#include "engine/graph/frame_graph.h"
#include "shared/input/camera.h"

namespace patina {

/// Which neighbours lie on one surface: those whose depths differ by at most floor_m + relative z.
struct DepthJump {
    float floor_m = 0.01f;
    float relative = 0.03f;
};

struct UnprojectedDepth {
    graph::ImageId position_m;  ///< rgba32f, world; w = 1 where there is a reading, else all 0
    /// rgba16f, world, unit length, towards the camera; w = 0. All 0 where there is no reading, at the picture's
    /// border, and where one of the four neighbours has no reading or lies on another surface.
    graph::ImageId normal;
};

/// Turns `depth_m` (r32f in metres, 0 where there is no reading) of a pinhole camera into world positions and normals,
/// these from central differences. Throws Error when the extents of image and camera differ.
UnprojectedDepth add_unproject_depth(graph::FrameGraph& frame, graph::ImageId depth_m, const gpu::Camera& camera,
                                     const DepthJump& jump = {});

}  // namespace patina
