#ifndef PATINA_LIB_PI_GLSL
#define PATINA_LIB_PI_GLSL

const float kPi = 3.14159265358979;

#endif
