#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/light_tracks.h"
#include "shared/lighting/find_lights.h"

namespace patina {

/// What is a lamp, and which sightings are of one.
struct FindLightsSettings {
    float threshold = 0.1f;      ///< luminance of a pixel value (1 is full scale) from which a pixel shines
    float bandwidth_m = 0.15f;   ///< radius of the mean-shift kernel; lamps closer together are one
    float bandwidth_rad = 0.1f;  ///< the same for emitters without depth, as an angle between bearings
    float match_m = 0.3f;        ///< sightings of one lamp in different frames lie within this
    float match_rad = 0.1f;      ///< the same for bearings from frame to frame
};

/// One frame's pictures, as the input passes made them.
struct FindLightsInputs {
    graph::ImageId depth_m;  ///< r32f, depth camera; 0 where there is no reading
    gpu::Camera depth_camera;
    graph::ImageId color;  ///< rgba16f, colour camera, linear; alpha as shared/input/convert_color.h says
    gpu::Camera color_camera;
    float radiance_scale = 1;  ///< exposure of the reflectance sequence / exposure of this frame
};

/// Finds the lamps in a frame of low exposure and joins them to those seen before (paper, Section 3.2): pixels above a
/// luminance threshold, back-projected, clustered by mean-shift; per cluster the centre of the sphere that it appears
/// as, and the intensity I = mean radiance x its disc's area, pi R^2. Clusters without depth give bearings. Those at
/// the picture's border, which may be cut off, are left out.
void add_find_lights(graph::FrameGraph& frame, LightTrackIds& tracks, const FindLightsInputs& inputs,
                     const FindLightsSettings& settings);

/// Medians over all sightings; for lamps without depth the point nearest to their bearings. Returns
/// gpu::FoundLight[kMaxLights]; sightings 0 where there is no light, or bearings too much alike to tell where.
graph::BufferId add_settle_lights(graph::FrameGraph& frame, const LightTrackIds& tracks);

}  // namespace patina
