#ifndef PATINA_LIB_MEAN_GLSL
#define PATINA_LIB_MEAN_GLSL

float mean_of(vec3 rgb) { return dot(rgb, vec3(1.0 / 3.0)); }

#endif
