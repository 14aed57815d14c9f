// Lens distortion, for shared/input/lens.h. Functions without bindings.
#ifndef PATINA_LIB_LENS_GLSL
#define PATINA_LIB_LENS_GLSL
#include "shared/input/lens.h"

// Finds where the distorted picture shows what the pinhole camera of the same focal length and centre shows at `pixel`.
// False where the distorted picture does not show it.
bool find_source(Lens lens, uvec2 pixel, out vec2 source_px) {
    const vec2 point = (vec2(pixel) - lens.focal_center_px.zw) / lens.focal_center_px.xy;
    const float r2 = dot(point, point);
    const float radial = 1.0 + r2 * (lens.radial.x + r2 * (lens.radial.y + r2 * lens.radial.z));
    const vec2 tangential = 2.0 * point.x * point.y * lens.tangential + lens.tangential.yx * (r2 + 2.0 * point * point);
    source_px = (point * radial + tangential) * lens.focal_center_px.xy + lens.focal_center_px.zw;
    return r2 <= lens.radial.w && all(greaterThanEqual(source_px, vec2(-0.5))) &&
           all(lessThan(source_px, vec2(lens.extent) - 0.5));
}

#endif
