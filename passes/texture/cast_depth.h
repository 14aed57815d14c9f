#pragma once

#include <optional>

#include "engine/graph/frame_graph.h"

namespace patina {

/// The depth of a view of the model: r32f, metres along the optical axis, 0 where nothing was hit. `position_m`: as
/// PredictRadianceInputs has it. Returns an image of its extent, `target` where there is one. Throws Error when that
/// has another extent.
graph::ImageId add_cast_depth(graph::FrameGraph& frame, graph::ImageId position_m,
                              std::optional<graph::ImageId> target = std::nullopt);

}  // namespace patina
