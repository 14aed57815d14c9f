#pragma once

#include "engine/graph/frame_graph.h"
#include "patina/camera.h"

namespace patina {

/// Fits a tangent plane to each reading from its neighbours in a (smoothed) depth image, W x H r32f in metres, 0 where
/// there is no reading. Neighbours across a depth jump are left out; a reading without any in x or y (a flying pixel,
/// or a surface seen nearly edge-on) is not fused. Returns W x H r32ui, packed as shaders/lib/map/slope.glsl says:
/// depth per pixel in x and y, the factor that turns a difference of depths along a ray into a distance from the plane,
/// and whether one of the eight pixels around shows a nearer surface; 0 where there is no plane. Throws Error when the
/// camera's extent is not the image's.
graph::ImageId add_measure_slope(graph::FrameGraph& frame, graph::ImageId smooth_depth_m, const Intrinsics& camera);

}  // namespace patina
