// What a ray meets of the surroundings. The includer declares
//   layout(std430, binding = n) readonly buffer Surroundings {
//       SURROUNDINGS_MEMBERS
//   };
#ifndef PATINA_LIB_MARCH_SURROUNDINGS_GLSL
#define PATINA_LIB_MARCH_SURROUNDINGS_GLSL
#include "lib/lighting/surroundings.glsl"
#include "lib/map/occupancy.glsl"
#include "lib/math/octahedral.glsl"
#include "shared/reflectance/far_field.h"

const float kReachCells = 256.0;     // 12.8 m
const uint kMostSteps = 160u;        // through cells, and through cubes without any
const float kOwnSurfaceCells = 1.5;  // what is no higher above the surface that a ray leaves is part of it

const uint kNoPlace = 0xffffffffu;

// Where the table has a cell; kNoPlace where it has none.
uint find_surroundings(ivec3 cell) {
    const uint key = surroundings_key(cell);
    for (uint probe = 0u; probe < kSurroundingsProbes; ++probe) {
        const uint place = surroundings_place(key, probe);
        const uint found = surroundings[place].key;
        if (found == key) return place;
        if (found == 0u) break;
    }
    return kNoPlace;
}

struct SurroundingsColor {
    vec4 mean;     // a is 0 where there is no surface
    bool opening;  // it shows what is behind it
};

SurroundingsColor look_up_surroundings(ivec3 cell) {
    const uint place = find_surroundings(cell);
    if (place == kNoPlace) return SurroundingsColor(vec4(0.0), false);
    const uint samples = samples_of(surroundings[place].light);
    if (samples < kLeastSurroundingsSamples) return SurroundingsColor(vec4(0.0), false);
    const vec4 mean = vec4(mean_radiance(surroundings[place].light), 1.0);
    return SurroundingsColor(mean, 2u * surroundings[place].openings > samples);
}

const float kLeastSky = 0.5;       // radiance; where pictures are exposed for a room, its sky is clipped, or nearly
const float kLeastOpening = 0.15;  // radiance; darker ones are black or shiny things that the depth camera does not see

// What arrives from a cell in a direction. A window shows what is far behind it, so that it is not the same from
// everywhere: what windows showed in this direction, or beside it, tells more than what this cell showed.
vec3 radiance_towards(SurroundingsColor met, vec3 direction) {
    if (!met.opening || max(max(met.mean.r, met.mean.g), met.mean.b) < kLeastOpening) return met.mean.rgb;
    const uint texel = octahedral_texel(direction, kOpeningEdge);
    if (openings[texel].known == 0u) return met.mean.rgb;
    return vec3(openings[texel].r, openings[texel].g, openings[texel].b);
}

struct MetSurroundings {
    vec4 color;  // a is 0 where nothing was met
    vec3 at_m;   // the middle of the cell
    bool opening;
};

// The first surface along a ray that leaves a surface with a normal, of those whose brightest channel is `least` or
// more. Cubes without any cell are crossed in one step.
MetSurroundings march_surroundings(vec3 point_m, vec3 normal, vec3 direction, float least) {
    const vec3 start = point_m / kSurroundingsCellM;
    const vec3 way = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6))), inverse = 1.0 / way;
    const ivec3 stride = ivec3(sign(way));
    const vec3 ahead = max(vec3(stride), 0.0);
    ivec3 cell = ivec3(floor(start));
    const float reach = surroundings_counts.total + surroundings_counts.fresh > 0u ? kReachCells : 0.0;
    float along = 0.0;  // the ray, cells
    int cube = EMPTY_CUBE(cells_in_use, cell);
    SurroundingsColor met = SurroundingsColor(vec4(0.0), false);
    for (uint i = 0u; i < kMostSteps && along < reach && met.mean.a == 0.0; ++i) {
        const int edge = 1 << max(cube, 0);
        const ivec3 corner = cell & -edge;
        // To the border of the cell, or of the cube, that the ray meets first.
        const vec3 borders = (vec3(corner) + float(edge) * ahead - start) * inverse;
        const bvec3 nearest = lessThanEqual(borders, min(borders.yzx, borders.zxy));
        const ivec3 axis = nearest.x ? ivec3(1, 0, 0) : nearest.y ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
        along = max(along, dot(vec3(axis), borders));
        const ivec3 inside = clamp(ivec3(floor(start + along * way)), corner, corner + edge - 1);
        const ivec3 beyond = corner + edge * ivec3(ahead) + min(stride, 0);
        cell = inside * (1 - axis) + beyond * axis;
        cube = EMPTY_CUBE(cells_in_use, cell);
        if (cube < 0 && dot(vec3(cell) + 0.5 - start, normal) > kOwnSurfaceCells) met = look_up_surroundings(cell);
        if (max(max(met.mean.r, met.mean.g), met.mean.b) < least) met.mean = vec4(0.0);
    }
    const vec3 at_m = (vec3(cell) + 0.5) * kSurroundingsCellM;
    return MetSurroundings(vec4(radiance_towards(met, direction), met.mean.a), at_m, met.opening);
}

// Whether a sun can shine in along a ray that no surface blocks: through an opening in which the sky was seen. What
// was never seen, such as a ceiling, is none. Where nothing at all is known of the surroundings it can.
bool passes_sky(vec3 point_m, vec3 normal, vec3 direction) {
    if (surroundings_counts.total + surroundings_counts.fresh == 0u) return true;
    return march_surroundings(point_m, normal, direction, kLeastSky).color.a > 0.0;
}

// What low exposure showed of a cell that the usual one clips, or nearly; 0 where it did not look, or all is seen.
vec3 low_exposure_radiance(ivec3 cell) {
    const uint place = find_surroundings(cell);
    if (place == kNoPlace || surroundings[place].light.low.samples < kLeastSurroundingsSamples) return vec3(0.0);
    const vec3 radiance = mean_of_sums(surroundings[place].light.low);
    return max(max(radiance.r, radiance.g), radiance.b) > kNearlyClipped ? radiance : vec3(0.0);
}

#endif
