#ifndef PATINA_LIB_LUMINANCE_GLSL
#define PATINA_LIB_LUMINANCE_GLSL

// Of linear RGB with the primaries of sRGB (ITU-R BT.709).
float luminance(vec3 linear) { return dot(linear, vec3(0.2126, 0.7152, 0.0722)); }

#endif
