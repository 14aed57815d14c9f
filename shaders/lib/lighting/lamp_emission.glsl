// How a lamp shines: all around alike, or as a flat one, by the cosine to its axis (Lambert).
#ifndef PATINA_LIB_LAMP_EMISSION_GLSL
#define PATINA_LIB_LAMP_EMISSION_GLSL
#include "shared/lighting/lights.h"

// The part of its intensity that it sends towards a surface; `to_lamp` is the unit direction from there.
float emission_from(PointLight lamp, vec3 to_lamp) { return max(lamp.axis.w - dot(lamp.axis.xyz, to_lamp), 0.0); }

vec3 intensity_from(PointLight lamp, vec3 to_lamp) { return lamp.intensity.rgb * emission_from(lamp, to_lamp); }

#endif
