// What a record receives of the lamps that reach it. The includer declares
//   layout(std140, binding = n) uniform Lights { LightHeader header; PointLight lights[kMaxPointLights]; };
#ifndef PATINA_LIB_LAMP_LIGHT_GLSL
#define PATINA_LIB_LAMP_LIGHT_GLSL
#include "lib/lighting/lamp_emission.glsl"
#include "lib/math/pi.glsl"

// Irradiance over pi that a lamp without anything before it sends to a surface.
vec3 lamp_light(uint lamp, vec3 point_m, vec3 normal) {
    const vec3 offset_m = lights[lamp].position_m.xyz - point_m;
    const float distance2 = max(dot(offset_m, offset_m), 1e-6);
    const vec3 to_lamp = offset_m * inversesqrt(distance2);
    return intensity_from(lights[lamp], to_lamp) * (max(dot(normal, to_lamp), 0.0) / (distance2 * kPi));
}

#endif
