#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/segmentation/frame_segments.h"
#include "shared/input/camera.h"
#include "shared/segmentation/find_edges.h"

namespace patina {

/// How much a depth scatters: sigma(z) = floor_m + per_m z^2. The defaults are a Kinect v2's, 1 to 2 mm at 1 m and 5 mm
/// at 4 m.
struct DepthNoise {
    float floor_m = 0.001f;
    float per_m = 0.00025f;  ///< 1 / m
};

/// What belongs together in a frame.
struct EdgeSettings {
    DepthNoise noise;
    /// Pixels k apart lie on one surface where their depths differ by at most jump_m plus k times what a surface with
    /// the steepest inclination changes from pixel to pixel.
    float jump_m = 0.01f;
    float steepest_degrees = 80;
    float reach_m =
        0.015f;  ///< normals come from pixels so far away on a surface seen head-on, and are compared there,
    uint32_t min_reach_px = 2;
    uint32_t max_reach_px = 4;
    float crease_degrees = 20;    ///< a concave crease separates where it turns the normal by more than this
    float crease_sigmas = 0.5f;   ///< and so many times what noise does to the angle
    float step_m = 0.004f;        ///< and a step separates parallel surfaces where it is higher than this
    float step_sigmas = 1;        ///< and so many sigmas of the depth
    float cut_chroma = 0.08f;     ///< and so does a change of r / (r + g + b), or g's, by more than this
    float cut_light = 0.012f;     ///< and this over r + g + b, as noise does more to dark colours
    float claim_m = 0.006f;       ///< an edge pixel joins a segment whose tangent plane is so near
    float claim_sigmas = 3;       ///< and so many sigmas of its depth,
    uint32_t claim_reach_px = 6;  ///< within so many pixels in x or y
    uint32_t color_reach_px = 2;  ///< how far on both sides of a pixel colours are compared
};

/// The parameters that passes on a frame's surface share; components of fewer than `min_pixels` get no pixels. Settings
/// count pixels of the camera; passes look at every `stride_px`-th of them in x and y. Throws Error for a reach or
/// stride below 1 px, or bounds that cross.
gpu::FrameSurfaceParams make_surface_params(const gpu::Camera& camera, const EdgeSettings& settings,
                                            uint32_t min_pixels, uint32_t stride_px = 1);

/// What a depth camera sees of a frame.
struct FrameSurface {
    graph::ImageId depth_m;  ///< W x H r32f; 0: nothing
    graph::ImageId chroma;   ///< W x H r32ui: chromaticity, packed as shaders/lib/color/chroma.glsl says; 0: not known
};

/// A picture, and the camera that took it.
struct ColorPicture {
    graph::ImageId color_linear;  ///< rgba16f (add_convert_color)
    gpu::Camera camera;
};

/// The model's depth where there is one, else the reading, and its colours. `model_position_m`: W x H rgba32f, w is
/// depth, 0 where nothing was hit (add_raycast). `reading_m`: W x H r32f, smoothed, 0 where there is none
/// (add_filter_depth); both seen by `camera`. Every `stride_px`-th pixel in x and y is looked at: images of W x H over
/// that, rounded up, of which the other passes see no more. Throws Error when extents differ.
FrameSurface add_choose_depth(graph::FrameGraph& frame, graph::ImageId model_position_m, graph::ImageId reading_m,
                              const gpu::Camera& camera, const ColorPicture& color, uint32_t stride_px = 1);

/// Normals from eight depths around each pixel of FrameSurface::depth_m. Returns W x H r32ui:
/// unit normals in camera coordinates, towards the camera, packed as shaders/lib/segments/frame_surface.glsl says; 0
/// where none is known. Throws Error when extents differ.
graph::ImageId add_fit_normals(graph::FrameGraph& frame, graph::ImageId depth_m, const gpu::FrameSurfaceParams& params);

/// Finds edges between the smooth, convex parts of a surface, with normals from add_fit_normals (phi_c of Tateno,
/// Tombari and Navab 2015; their depth discontinuity is the jump between connected pixels, add_label_components, and
/// small steps are creases at their foot). A pixel is at an edge where the normals on both sides of it differ and face
/// each other, where both sides are parallel but one lies behind the other, where their colours differ, or where its
/// own normal is not known. Returns W x H r32f: depth in metres, negative at edges, 0 where there is no surface. Throws
/// Error when extents differ.
graph::ImageId add_find_edges(graph::FrameGraph& frame, const FrameSurface& surface, graph::ImageId normal,
                              const gpu::FrameSurfaceParams& params);

}  // namespace patina
