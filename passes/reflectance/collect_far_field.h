#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/reflectance_state.h"
#include "shared/reflectance/far_field.h"

namespace patina {

/// A frame, and the model as its depth camera sees it.
struct FarFieldInputs {
    graph::ImageId position_m;    ///< W x H rgba32f: world; w is 0 where nothing was hit
    graph::ImageId depth_m;       ///< W x H r32f, metres; 0: no reading
    graph::ImageId color_linear;  ///< the colour camera's rgba16f; a = 0: no reading
    gpu::Camera depth_camera;
    gpu::Camera color_camera;
    uint32_t frame_index = 0;
};

/// Adds the colours of pixels that show no surface, neither in the depth picture nor in the model nor six pixels
/// around, to state.surroundings: light from far away, by direction alone. One pixel of 64 looks in a frame, others in
/// each; frames after the first kMostFarFieldFrames add nothing, so that no sum overflows. Throws Error when position_m
/// and depth_m differ in extent.
void add_collect_far_field(graph::FrameGraph& frame, ReflectanceStateIds& state, const FarFieldInputs& inputs);

/// A sum of 32 bits holds as many frames that fill a texel: 30 pixels of 64 x 6 degrees, of kColorRange each.
constexpr uint32_t kMostFarFieldFrames = 32768;

}  // namespace patina
