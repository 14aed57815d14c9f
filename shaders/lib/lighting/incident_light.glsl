// What arrives at a surface along a ray: the fused colour of what it meets, what the surroundings show there where that
// is clipped or the map shows nothing, or the far field. The includer declares
// what lib/map/march_map.glsl needs and
//   COLOR(C, i)     uint, the colour of voxel i of the literal chunk C
//   layout(std140, binding = n) uniform Lights { LightHeader header; PointLight lights[kMaxPointLights]; };
//   layout(std430, binding = n) readonly buffer Surroundings {
//       SURROUNDINGS_MEMBERS
//   };
#ifndef PATINA_LIB_INCIDENT_LIGHT_GLSL
#define PATINA_LIB_INCIDENT_LIGHT_GLSL
#define BLOCKS_IN_USE blocks_in_use
#include "lib/lighting/far_field.glsl"
#include "lib/lighting/march_surroundings.glsl"
#include "lib/map/march_map.glsl"

const float kRayLiftVox = 2.5;            // from where a ray starts, above the surface
const float kRayMostSkippedVox = 7.5;     // of the ray, to get there
const float kLeastEmittedRadiance = 0.9;  // a colour from which on it may be a lamp's own, clipped or nearly
const float kLampShare = 1.5;             // of a lamp's radius: so far from its middle colours are its own
const float kUnknownLampM = 0.15;         // the radius assumed of a lamp whose radius is not known

// The colour of the surface that a ray met at `at_vox`: of the voxel there, or next to it on the ray. a is 0 where none
// has one.
vec4 surface_color(vec3 at_vox, vec3 direction) {
    [[unroll]] for (int i = 0; i < 3; ++i) {
        const float step_vox = i == 0 ? 0.0 : i == 1 ? 1.0 : -1.0;
        const ivec3 voxel = ivec3(floor(at_vox + step_vox * direction));
        const uint block = find_block(grid, voxel >> 3);
        if (block == kNoBlock) continue;
        const uint index = index_of_voxel(block, voxel);
        uint color;
#define LOAD_COLOR(C) color = COLOR(C, index)
        WITH_CHUNK(grid.chunk_shift, block, LOAD_COLOR)
        if (color != 0u) return vec4(voxel_color(color), 1.0);
    }
    return vec4(0.0);
}

bool is_lamp(vec3 point_m) {
    for (uint i = 0u; i < header.count; ++i) {
        const float radius_m = lights[i].position_m.w > 0.0 ? lights[i].position_m.w : kUnknownLampM;
        if (distance(lights[i].position_m.xyz, point_m) < kLampShare * radius_m + 2.0 * grid.voxel_m) return true;
    }
    return false;
}

struct Incident {
    vec3 radiance;
    bool known;
    bool lamp;  // it comes from a lamp, whose intensity counts elsewhere; the radiance is 0
};

// What arrives within a ball (metres) along a ray from a surface with a normal.
Incident incident_light(vec3 point_vox, vec3 normal, vec3 direction, vec4 ball_m) {
    const float cosine = dot(direction, normal);
    const float skipped = min(kRayLiftVox / max(cosine, 1e-6), kRayMostSkippedVox);
    const float lift = max(kRayLiftVox - skipped * cosine, 0.0);
    const vec3 start = point_vox + lift * normal;
    const float hit = find_hit(start, direction, skipped, to_ball_end(start, direction, ball_m));
    vec3 at_m = (start + hit * direction) * grid.voxel_m;
    vec4 color = hit < 0.0 ? vec4(0.0) : surface_color(start + hit * direction, direction);
    bool met_surface = hit >= 0.0, opening = false;
    if (!met_surface) {
        const MetSurroundings met = march_surroundings(point_vox * grid.voxel_m, normal, direction, 0.0);
        met_surface = met.color.a > 0.0;
        opening = met.opening;
        at_m = met.at_m;
        color = met_surface ? met.color : far_radiance(far_field[far_field_texel(direction)]);
    }
    if (met_surface && max(max(color.r, color.g), color.b) > kLeastEmittedRadiance) {
        if (is_lamp(at_m)) return Incident(vec3(0.0), true, true);
        if (!opening) color.rgb = max(color.rgb, look_up_surroundings(surroundings_cell(at_m)).mean.rgb);
    }
    return Incident(color.rgb, color.a > 0.0, false);
}

#endif
