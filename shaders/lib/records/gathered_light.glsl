// Light that reaches a record from what is around it: reflected by walls and things, sent out by what is no lamp. Rays
// in cosine-weighted directions gather it, so that the mean of what they meet is the irradiance over pi. Functions
// without bindings.
//   x  red, green of the mean over the rays that met something: half floats
//   y  blue likewise | rays that met something, 8 bits << 16 | rays that met nothing known, 8 bits << 24
#ifndef PATINA_LIB_GATHERED_LIGHT_GLSL
#define PATINA_LIB_GATHERED_LIGHT_GLSL
#include "shared/reflectance/reflectance.h"

const float kMostGatheredRays = 192.0;  // of a record; from then on the mean is a sliding one

const float kRayError = 0.5;  // of a mean of usual rays, relative, times the square root of their number

struct GatheredLight {
    vec3 mean;     // radiance where a ray met something
    float met;     // rays
    float missed;  // that met nothing known
};

GatheredLight unpack_gathered(uvec2 packed) {
    const vec3 mean = vec3(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y).x);
    return GatheredLight(mean, float(packed.y >> 16 & 0xffu), float(packed.y >> 24));
}

uvec2 pack_gathered(GatheredLight light) {
    const uint blue = packHalf2x16(vec2(light.mean.b, 0.0)) & 0xffffu;
    const uvec2 rays = uvec2(min(round(vec2(light.met, light.missed)), 255.0));
    return uvec2(packHalf2x16(light.mean.rg), blue | rays.x << 16 | rays.y << 24);
}

// The light so far, with the `sum` over `met` new rays and `missed` others.
GatheredLight with_rays(GatheredLight light, vec3 sum, float met, float missed) {
    const float before = light.met + light.missed;
    const float kept = before > 0.0 ? min((kMostGatheredRays - met - missed) / before, 1.0) : 1.0;
    const float met_before = kept * light.met;
    const vec3 mean = (met_before * light.mean + sum) / max(met_before + met, 1.0);
    return GatheredLight(mean, met_before + met, kept * light.missed + missed);
}

// Irradiance over pi. Where nothing is known the light is `ambient`, or as bright as the rest where that is not known.
vec3 gathered_irradiance(GatheredLight light, vec3 ambient) {
    const float rays = light.met + light.missed;
    if (rays == 0.0) return ambient;
    const bool ambient_known = max(max(ambient.r, ambient.g), ambient.b) > 0.0;
    const vec3 unknown = ambient_known ? ambient : light.mean;
    return (light.met * light.mean + light.missed * unknown) / rays;
}

// What of it a gloss of ks sends to any viewer, as if it arrived alike from everywhere; none where no ray was gathered.
vec3 gathered_gloss(GatheredLight light, vec3 ambient, vec3 ks) {
    return light.met + light.missed > 0.0 ? ks * gathered_irradiance(light, ambient) : vec3(0.0);
}

#endif
