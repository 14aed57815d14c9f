// What interpolation between records needs of one, in a uvec4: one load for each of eight neighbours. Functions without
// bindings.
//   x  kd, shared exponent
//   y  its certainty, 3 x 10 bits | lights were marched from it << 30 | it has a label << 31
//   z  normal snorm 8 + 8 + 8, without need to decode octahedra | offset snorm 8 along it from the voxel's centre, in
//      voxels
//   w  the first 32 lights that reach it, a bit each
#ifndef PATINA_LIB_PACKED_RECORDS_GLSL
#define PATINA_LIB_PACKED_RECORDS_GLSL
#include "lib/records/reflectance.glsl"

uvec4 pack_record(VoxelRecord record, uvec2 albedo, bool marched, uint visibility) {
    const uint flags = (marched ? 1u << 30 : 0u) | (record_label(record) != 0u ? 1u << 31 : 0u);
    const vec4 surface = vec4(surface_normal(record), surface_offset_vox(record));
    return uvec4(albedo.x, albedo.y | flags, packSnorm4x8(surface), visibility);
}

vec3 packed_raw_kd(uvec4 packed) { return albedo_raw_kd(packed.xy); }
vec3 packed_certainty(uvec4 packed) { return albedo_certainty(packed.xy); }
bool packed_is_known(uvec4 packed) { return (packed.y & 0x3fffffffu) != 0u; }
bool packed_marched(uvec4 packed) { return (packed.y & 1u << 30) != 0u; }
bool packed_has_label(uvec4 packed) { return (packed.y & 1u << 31) != 0u; }
// xyz: the normal, of unit length but for rounding; w: the offset.
vec4 packed_surface(uvec4 packed) {
    return vec4(int(packed.z << 24) >> 24, int(packed.z << 16) >> 24, int(packed.z << 8) >> 24, int(packed.z) >> 24) *
           (1.0 / 127.0);
}

#endif
