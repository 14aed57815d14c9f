#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/shading/predict_radiance.h"

namespace patina {

/// What detail is restored from; all images have one extent.
struct RestoreDetailInputs {
    graph::ImageId position_m;  ///< W x H rgba32f: world; w: depth in metres, 0 where nothing was hit
    graph::ImageId normal;      ///< W x H rgba16f: world, unit length; 0 where it is not known
    graph::ImageId color;       ///< W x H rgba16f: fused colour, linear; a = 0 where there is none (add_shade_color)
    float focal_px = 0;         ///< of the camera that sees them
    float voxel_m = 0;          ///< of the observations
};

/// Restores detail of the albedo that is finer than the observations' voxels, of which the finer voxels of the fused
/// colour know: kd becomes the fused colour over the light, scaled such that its mean over the voxels around the point
/// is the mean of kd there, so that light and highlights that change little within a voxel cancel out. Where kd is not
/// known yet it becomes the fused colour over the light, which then is known. Where no light was marched yet, rgb is
/// the fused colour, as full light would shine in shadows. Where shadows end within that neighbourhood, where there is
/// too little light, or where no colour was fused, kd stays; so do label, ks_alpha and light. Contrast no stronger than
/// what shading and highlights may leave in the fused colours counts little. rgb gets the same detail of picture_kd.
/// Returns the predicted images with kd and rgb replaced; picture_kd stays without detail. Throws Error when extents
/// differ.
PredictedImages add_restore_detail(graph::FrameGraph& frame, const PredictedImages& predicted,
                                   const RestoreDetailInputs& inputs);

}  // namespace patina
