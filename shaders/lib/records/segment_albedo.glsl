// What a record adds to its segment's albedo. Functions without bindings.
#ifndef PATINA_LIB_SEGMENT_ALBEDO_GLSL
#define PATINA_LIB_SEGMENT_ALBEDO_GLSL
#include "lib/records/reflectance.glsl"

SegmentAlbedo albedo_sums(VoxelRecord record, uvec2 albedo) {
    const uvec3 weight = uvec3(round(albedo_certainty(albedo) * kCertaintySteps));
    const uvec3 kd = uvec3(round(clamp(albedo_kd(albedo), 0.0, 1.0) * kAlbedoSteps)) * weight;
    return SegmentAlbedo(uvec4(kd, 1u), uvec4(weight, observation_count(record)));
}

#endif
