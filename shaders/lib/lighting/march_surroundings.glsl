// What a ray meets of the surroundings. The includer declares
//   layout(std430, binding = n) readonly buffer Surroundings {
//       FarFieldTexel far_field[kFarFieldTexels];
//       SurroundingsCell surroundings[];
//   };
#ifndef PATINA_LIB_MARCH_SURROUNDINGS_GLSL
#define PATINA_LIB_MARCH_SURROUNDINGS_GLSL
#include "lib/lighting/surroundings.glsl"
#include "shared/reflectance/far_field.h"

const uint kMostCrossings = 256u;    // cells of a ray: 7 m at least
const float kOwnSurfaceCells = 1.5;  // what is no higher above the surface that a ray leaves is part of it

// The mean colour of a cell; a is 0 where there is no surface in it.
vec4 look_up_surroundings(ivec3 cell) {
    const uint key = surroundings_key(cell);
    for (uint probe = 0u; probe < kSurroundingsProbes; ++probe) {
        const uint place = surroundings_place(key, probe);
        const uint found = surroundings[place].key;
        if (found == key) {
            const uint samples = surroundings[place].usual.samples + surroundings[place].low.samples;
            const bool known = samples >= kLeastSurroundingsSamples;
            return known ? vec4(cell_radiance(surroundings[place]), 1.0) : vec4(0.0);
        }
        if (found == 0u) break;
    }
    return vec4(0.0);
}

struct MetSurroundings {
    vec4 color;  // a is 0 where nothing was met
    vec3 at_m;   // the middle of the cell
};

// The first surface along a ray that leaves a surface with a normal.
MetSurroundings march_surroundings(vec3 point_m, vec3 normal, vec3 direction) {
    const vec3 start = point_m / kSurroundingsCellM;
    const vec3 inverse = 1.0 / mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    const ivec3 stride = ivec3(sign(inverse));
    ivec3 cell = ivec3(floor(start));
    vec3 next = (vec3(cell) + max(vec3(stride), 0.0) - start) * inverse;  // along the ray, to each axis' next border
    vec4 met = vec4(0.0);
    for (uint i = 0u; i < kMostCrossings && met.a == 0.0; ++i) {
        const bvec3 nearest = lessThanEqual(next, min(next.yzx, next.zxy));
        const ivec3 axis = nearest.x ? ivec3(1, 0, 0) : nearest.y ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
        cell += axis * stride;
        next += vec3(axis) * abs(inverse);
        if (dot(vec3(cell) + 0.5 - start, normal) > kOwnSurfaceCells) met = look_up_surroundings(cell);
    }
    return MetSurroundings(met, (vec3(cell) + 0.5) * kSurroundingsCellM);
}

#endif
