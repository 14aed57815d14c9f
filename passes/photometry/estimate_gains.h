#pragma once

#include "engine/graph/frame_graph.h"
#include "shared/photometry/color_gains.h"

namespace patina {

/// How gains are estimated from what was seen before.
struct GainSettings {
    uint32_t reduction = 4;        ///< the model is compared at every so many-th pixel of the colour picture in x and y
    float max_angle_degrees = 60;  ///< between the normal and the direction to the camera: flatter views reflect more
    uint32_t min_samples = 200;    ///< with fewer pixels that can be compared, a channel keeps the gain before
    /// Gains are found against colours that earlier gains corrected, so that errors add up over a long way. Each
    /// gain's logarithm loses this share: over surfaces never seen before, errors are forgotten after some 1 / leak
    /// frames, and a gain that is right is off by its own leak alone (0.1 % at a gain of 1.6). What was seen with the
    /// first gains holds the later ones wherever the camera comes back to it.
    float leak = 0.002f;
};

struct GainInputs {
    graph::ImageId position_m;    ///< the model before this frame, cast into the colour camera at a reduced extent
    graph::ImageId normal;        ///< its normals
    graph::ImageId model_color;   ///< its fused colour there (add_shade_color)
    graph::ImageId color_linear;  ///< the frame's colour (add_convert_color)
    glm::vec3 camera_m{0};        ///< the colour camera's centre, world
};

/// Estimates by what the camera's automatic exposure and white balance multiplied this frame's linear colours, relative
/// to the first frame's: per channel the robust centre of log(frame / model) over pixels that are unclipped, neither
/// grazing nor near an edge of the model or of the picture, and well exposed. Replaces `gains`
/// (gpu::ColorGains), which holds those of the frame before; where too few pixels can be compared they stay. Throws
/// Error when images of the model differ in extent or a setting is out of its range.
graph::BufferId add_estimate_gains(graph::FrameGraph& frame, const GainInputs& inputs, graph::BufferId gains,
                                   const GainSettings& settings = {});

/// Divides a colour image (rgba16f, add_convert_color) by a frame's gains. What is clipped or invalid stays marked.
graph::ImageId add_apply_gains(graph::FrameGraph& frame, graph::ImageId color_linear, graph::BufferId gains);

}  // namespace patina
