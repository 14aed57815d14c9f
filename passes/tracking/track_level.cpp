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

Intrinsics strided(const Intrinsics& camera, uint32_t stride) {
    const double each = stride, first = stride / 2;
    Intrinsics sparse;
    sparse.extent = {camera.extent.width / stride, camera.extent.height / stride};
    sparse.fx = camera.fx / each;
    sparse.fy = camera.fy / each;
    sparse.cx = (camera.cx - first) / each;
    sparse.cy = (camera.cy - first) / each;
    return sparse;
}

}  // namespace patina
