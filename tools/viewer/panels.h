#pragma once

#include "patina/lighting.h"
#include "tools/viewer/viewer_state.h"

namespace patina::tools {

/// Shows all panels, in a window of so many pixels, and takes what the user does with them. `lighting`: that of the
/// reconstruction.
void show_panels(ViewerState& state, const ViewerFacts& facts, const Lighting& lighting, Extent2D window);

/// The user's own lights, which begin as those of the reconstruction.
OtherLights& own_lights(ViewerState& state, const Lighting& lighting);

}  // namespace patina::tools
