// Activations in the format that the includer defines: NETWORK_TEXELS, NETWORK_HALVES, or neither.
#ifdef NETWORK_TEXELS
#include "specular/layer_texels.glsl"
#elif defined NETWORK_HALVES
#include "specular/layer_halves.glsl"
#else
#include "specular/layer_floats.glsl"
#endif
