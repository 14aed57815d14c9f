#pragma once

#include "scenes/description/clearance.h"
#include "scenes/description/draws.h"
#include "scenes/description/path.h"

namespace patina::scenes {

/// A path like `path`: it starts elsewhere, and its distances and angles differ by up to 20 %, less where the camera
/// would otherwise lose more than half its least clearance, pass through a surface or look too steeply up or down. It
/// is not faster along either angle, or by its tour's period.
CameraPath varied(const CameraPath& path, Draws draws, const Clearance& clearance);

}  // namespace patina::scenes
