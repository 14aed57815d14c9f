// The lights of the room. See passes/state/lights.h.
#ifndef PATINA_SHARED_LIGHTS_H
#define PATINA_SHARED_LIGHTS_H
#include "shared/interop.h"
INTEROP_BEGIN

INTEROP_CONST uint kMaxPointLights = 64u;

struct PointLight {
    vec4 position_m;  // xyz world; w: radius of the lamp around it, 0 where unknown
    vec4 intensity;   // rgb, linear pixel value * m^2; w: 1 of a sun (is_sun), which shines in where the sky is seen
    vec4 axis;        // xyz: unit direction to where a flat lamp shines, w 0; of others 0 0 0 1 (lamp_emission.glsl)
};

// What precedes the point lights in their buffer.
struct LightHeader {
    vec4 ambient;           // rgb irradiance / pi, linear pixel value; w unused
    uint count;             // of point lights
    uint version;           // changes with anything, above 0
    uint position_version;  // changes with positions and radii, above 0
    uint pad0;
};

INTEROP_END
#endif
