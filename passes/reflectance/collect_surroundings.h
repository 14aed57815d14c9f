#pragma once

#include "engine/graph/frame_graph.h"
#include "passes/state/reflectance_state.h"
#include "shared/reflectance/surroundings.h"

namespace patina {

/// A frame.
struct SurroundingsInputs {
    graph::ImageId depth_m;       ///< W x H r32f, metres; 0: no reading
    graph::ImageId color_linear;  ///< the colour camera's rgba16f; a = 0: no reading
    gpu::Camera depth_camera;
    gpu::Camera color_camera;
    uint32_t frame_index = 0;
    float radiance_scale = 0;  ///< of a frame of low exposure: the recording's exposure over its own; else 0
    float lamp_luminance = 0;  ///< of a frame of low exposure: of a pixel, 1 is full scale, from which it is a lamp's
};

/// Adds what a frame shows to state.surroundings: the mean colour of each cell of gpu::kSurroundingsCellM with a
/// surface in it. A pixel without depth between readings left and right of it, or above and below, 16 pixels apart or
/// more, shows an opening: a window, which lies in the plane of its rim, so that a mirror shows it there. What it shows
/// is far behind it, and is summed up by direction, too (gpu::OpeningTexel). What a direction shows that was not
/// seen is the mean of those around, up to 45 degrees off, by the inverse fourth power of the angle; a part of all
/// directions looks for it in each frame, all in gpu::kOpeningTurns of them. One pixel of 16 looks in a frame, others
/// in each; frames after the first kMostSurroundingsFrames, or kMostLowExposures, add nothing, so that no sum
/// overflows. Once gpu::kMostSurroundings cells are in use, no others are added. Frames of low exposure are summed up
/// apart: they tell what is clipped in the others. Their lamps, whose light counts by itself, are left out.
void add_collect_surroundings(graph::FrameGraph& frame, ReflectanceStateIds& state, const SurroundingsInputs& inputs);

/// So that no sum of 32 bits overflows. A cell at 0.3 m fills 150 x 150 pixels of a camera with a focal length of 900;
/// one of 16 looks, so that a frame adds 1400 samples. Each is kSurroundingsSteps at most, where pixel values end at 1,
/// and kSurroundingsRange times as much at low exposure. A direction of an opening fills 50 x 50 pixels of it.
constexpr uint32_t kMostSurroundingsFrames = 8192, kMostLowExposures = 700;

}  // namespace patina
