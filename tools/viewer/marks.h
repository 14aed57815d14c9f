#pragma once

#include <optional>
#include <span>

#include "tools/viewer/viewer_state.h"

namespace patina::tools {

/// A camera, and where it is.
struct ViewedFrom {
    Intrinsics camera;
    RigidTransform pose{1.0};  ///< world_from_camera
};

/// Draws over the picture, behind the panels: the handles of the lamps (the user's own, else `lights`), what was
/// clicked, and the frustum of a sensor that is not followed, with the field of view of `field_of`.
void draw_marks(const ViewedFrom& from, const ViewerState& state, const std::optional<RigidTransform>& sensor,
                const Intrinsics& field_of, std::span<const Light> lights);

}  // namespace patina::tools
