// What a picture tells of the albedo.
#ifndef PATINA_TEXTURE_ALBEDO_STATES_GLSL
#define PATINA_TEXTURE_ALBEDO_STATES_GLSL

const float kMostAlbedo = 1.5;  // what is above is a highlight that the model does not know

// Alpha of such a picture (diffuse_picture.comp) besides those of shared/input/convert_color.h: near where the surface
// ends, so that what is seen may be another one.
const float kColorAtEdge = 0.25;

#endif
