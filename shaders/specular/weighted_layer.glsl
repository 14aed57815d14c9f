// As layer.glsl, for layers that have weights.
#include "specular/layer.glsl"
#ifdef NETWORK_TEXELS
#include "specular/weights_texels.glsl"
#elif defined NETWORK_HALVES
#include "specular/weights_halves.glsl"
#else
#include "specular/weights_floats.glsl"
#endif
