#pragma once

#include "engine/graph/frame.h"
#include "shared/camera.h"

namespace patina {

/// How much a depth reading scatters: sigma(z) = floor_m + per_m z^2. The defaults are a Kinect v2's, 1 to 2 mm at 1 m
/// and 5 mm at 4 m.
struct DepthNoise {
    float floor_m = 0.001f;
    float per_m = 0.00025f;  ///< 1 / m
};

/// What counts as the same surface. Distances follow noise: a floor plus a number of sigmas.
struct EdgeSettings {
    DepthNoise noise;
    float agreement_floor_m = 0.01f;  ///< a reading so near to the model's tangent plane is the model's
    float agreement_sigmas = 3;
    float reach_m = 0.01f;  ///< pixels are compared with neighbours so far away on a surface seen head-on,
    uint32_t min_reach_px = 1;
    uint32_t max_reach_px = 4;
    float step_floor_m = 0.006f;  ///< least step that separates
    float step_sigmas = 3;
    float crease_degrees = 20;  ///< a concave crease separates where normals differ by more
};

/// The surface that a frame shows, from the model where it agrees with the readings, else from the readings.
struct SurfaceInputs {
    graph::ImageId model_position_m;  ///< W x H rgba32f: w is depth, 0 where nothing was hit (add_raycast)
    graph::ImageId model_normal;      ///< W x H rgba16f: world; 0 where there is none
    graph::ImageId depth_m;           ///< W x H r32f: smoothed readings; 0 where there is none
    graph::ImageId normal;            ///< W x H rgba16f: world, of depth_m (add_unproject_depth)
};

/// Chooses between model and readings for each pixel. Model where its normal is known, and there is no reading or one
/// that lies on its tangent plane. Returns W x H rgba32f: xyz is the unit normal in camera coordinates, towards the
/// camera, 0 where there is none; w is depth in metres, 0 where there is no surface. Throws Error when extents differ.
graph::ImageId add_choose_surface(graph::Frame& frame, const SurfaceInputs& inputs, const gpu::Camera& camera,
                                  const EdgeSettings& settings = {});

/// Finds edges between the smooth, convex parts of a surface (after Tateno, Tombari and Navab 2015). A pixel is at an
/// edge where, towards one of eight neighbours,
///  - the surface makes a step: each of the two points lies off the other's tangent plane, on opposite sides;
///  - or a concave crease: the points lie above each other's planes, and the normals differ;
/// or where the normal is unknown. `surface` as add_choose_surface returns it. Returns W x H r32f: depth in metres,
/// negative at edges, 0 where there is no surface. Throws Error for settings out of range, or when extents differ.
graph::ImageId add_find_edges(graph::Frame& frame, graph::ImageId surface, const gpu::Camera& camera,
                              const EdgeSettings& settings = {});

}  // namespace patina
