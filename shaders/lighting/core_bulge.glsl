// Where a lamp's distance is measured on its disc in the picture.
#ifndef PATINA_LIGHTING_CORE_BULGE_GLSL
#define PATINA_LIGHTING_CORE_BULGE_GLSL

// The part of the disc, in radii: at its rim depth readings mix with what is behind.
const float kCore = 0.5;
// Mean distance of a sphere's surface before its centre over that part, in radii: (2/3) (1 - (1 - f^2)^1.5) / f^2.
const float kCoreBulge = 0.934658;

#endif
