// Alpha of what a picture says of the albedo (albedo_picture.comp) besides those of shared/input/convert_color.h.
#ifndef PATINA_TEXTURE_ALBEDO_STATES_GLSL
#define PATINA_TEXTURE_ALBEDO_STATES_GLSL

const float kColorAtEdge = 0.25;  // near where the surface ends: what is seen may be another one

#endif
