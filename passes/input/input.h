#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/input/filter_depth.h"
#include "passes/input/unproject_depth.h"
#include "patina/frame.h"
#include "shared/input/camera.h"

namespace patina {

struct InputSettings {
    DepthFilter filter;
    DepthJump jump;
};

/// What the passes know of one RGB-D frame. Depth images have the depth camera's extent, `color` the colour camera's;
/// both belong to pinhole cameras.
struct InputImages {
    graph::ImageId depth_m;           ///< r32f, as measured; 0 where there is no reading (add_convert_depth)
    graph::ImageId filtered_depth_m;  ///< r32f, smoothed (add_filter_depth)
    UnprojectedDepth surface;         ///< of the smoothed depth (add_unproject_depth)
    graph::ImageId color;             ///< rgba16f, linear radiance (add_convert_color)
};

/// The two pictures of a frame as passes read them.
struct InputPictures {
    graph::ImageId depth_m;  ///< r32f (add_convert_depth)
    graph::ImageId color;    ///< rgba16f, linear radiance (add_convert_color)
};

/// Prepares what was converted; passes whose images nobody uses are culled. `depth_camera` is the pinhole camera of
/// `depth_m` at its pose.
InputImages add_input(graph::FrameGraph& frame, const InputPictures& pictures, const gpu::Camera& depth_camera,
                      const InputSettings& settings = {});

/// Uploads one frame and prepares it; passes whose images nobody uses are culled. `depth_camera` is the pinhole part of
/// `depth.camera` at its pose.
InputImages add_input(graph::FrameGraph& frame, const DepthInput& depth, const ColorInput& color,
                      const gpu::Camera& depth_camera, const InputSettings& settings = {});

}  // namespace patina
