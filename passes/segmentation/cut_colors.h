#pragma once

#include "engine/graph/frame.h"
#include "shared/camera.h"

namespace patina {

/// Colours that help to divide a frame.
struct ColorGuide {
    graph::ImageId color_linear;  ///< rgba16f; a = 0 where there is none
    gpu::Camera camera;           ///< that took them
    float chroma = 0.12f;         ///< r / (r + g + b), or g's, that differ by more belong to two things,
    int reach_px = 8;             ///< if a geometric edge is so near: pictures on a surface do not divide it
    float same_chroma = 0.04f;    ///< those that differ by less are the same thing, folded,
    float strong_chroma = 0.12f;  ///< if they lie farther than this from grey, which many things share
};

/// Adds edges to `inner_depth_m` (W x H r32f, negative at edges; add_find_edges, seen by `depth_camera`) where the
/// chromaticity changes within four pixels: where one thing stands flush on another, the crease between them has gaps.
/// Takes edges back where six pixels across, both ways, have one strong colour: a figure has creases of its own.
/// Returns W x H r32f of the same kind.
graph::ImageId add_cut_colors(graph::Frame& frame, graph::ImageId inner_depth_m, const gpu::Camera& depth_camera,
                              const ColorGuide& guide);

}  // namespace patina
