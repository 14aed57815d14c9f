// For the tests of lib/math/random.glsl, lib/math/sampling.glsl and lib/brdf/ward.glsl: one of everything per query.
#ifndef PATINA_SHARED_TEST_SAMPLING_H
#define PATINA_SHARED_TEST_SAMPLING_H
#include "shared/interop.h"
INTEROP_BEGIN

struct SamplingQuery {
    uvec4 seed_frame_pixel;  // xy: seed
    uvec4 index_dimension;   // xy; zw unused
    vec4 u;                  // xy: numbers; z: height of the cap; w unused
    vec4 normal;             // unit length; w: alpha
    vec4 to_viewer;          // unit length; w unused
    vec4 to_light;
    vec4 kd;  // w unused
    vec4 ks;
};

struct SamplingAnswer {
    uvec4 words;  // xy: the stream
    vec4 random;  // numbers
    vec4 stratified;
    vec4 tangent;  // basis; w unused
    vec4 bitangent;
    vec4 cosine;    // direction in the basis; w unused
    vec4 cap;       // direction in the basis; w unused
    vec4 ward;      // sampled direction; w: its density
    vec4 brdf;      // at to_light; w: density there
    vec4 reversed;  // brdf with light and viewer exchanged; w unused
    vec4 weight;    // brdf times cosine over density, of the sampled direction; w unused
};

struct SamplingParams {
    uint count;
};

INTEROP_END
#endif
