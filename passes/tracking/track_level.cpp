#include "passes/tracking/track_level.h"

namespace patina {

Intrinsics halved(const Intrinsics& camera) {
    Intrinsics half;
    half.extent = {camera.extent.width / 2, camera.extent.height / 2};
    half.fx = camera.fx / 2;
    half.fy = camera.fy / 2;
    half.cx = (camera.cx + 0.5) / 2 - 0.5;
    half.cy = (camera.cy + 0.5) / 2 - 0.5;
    return half;
}

}  // namespace patina
