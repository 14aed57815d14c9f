#version 460
#extension GL_GOOGLE_include_directive : require
// Samples the diffuse albedo and the segment at points of the surface, as re-rendering does at pixels. One invocation
// per point; records are found through the observation map's table.
#include "shared/shading/sample_reflectance.h"

layout(local_size_x = kSampleGroup) in;
layout(std430, binding = 0) readonly buffer Keys { uvec4 keys[]; };
layout(std430, binding = 1) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 2) readonly buffer RecordTable { uint record_table[]; };
layout(std430, binding = 3) readonly buffer Packed { uvec4 packed_records[]; };
layout(std430, binding = 4) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 5) readonly buffer Segments { SegmentAlbedo segments[]; };
layout(std430, binding = 6) readonly buffer Positions { float positions_m[]; };  // three per point
layout(std430, binding = 7) readonly buffer Normals { float normals[]; };
layout(std430, binding = 8) writeonly buffer Samples { SampledReflectance samples[]; };
layout(std430, binding = 9) readonly buffer Gathered { RecordSurroundings gathered[]; };
layout(push_constant) uniform Push { SampleReflectanceParams params; };
#define KEYS(bucket) keys[bucket]
#define BLOCK(slot) blocks[slot]
#define RECORD(entry) record_table[entry]
#include "lib/records/blend_records.glsl"
#include "lib/records/find_record.glsl"

// The trilinear mean over the eight records around the point.
Reflectance interpolate(SurfacePoint point) {
    const ivec3 low = ivec3(floor(point.at_vox));
    RecordSums sums = no_records();
    for (int i = 0; i < 8; ++i) {
        const ivec3 voxel = low + ivec3(i & 1, i >> 1 & 1, i >> 2);
        const uint record = find_record(params.grid, params.edge_shift, voxel);
        const vec3 away = point.at_vox - vec3(voxel), share = 1.0 - abs(away);
        if (record != kNoRecord)
            add_record(sums, point, record, packed_records[record], gathered[record].around, away,
                       share.x * share.y * share.z);
    }
    return mean_of(sums);
}

// Where none of the eight is known: the nearest within one voxel more.
Reflectance fill(SurfacePoint point, Reflectance found) {
    const ivec3 low = ivec3(floor(point.at_vox)) - 1;
    NearestRecords nearest = nearest_after(found);
    for (int i = 0; i < 64; ++i) {
        const ivec3 voxel = low + ivec3(i & 3, i >> 2 & 3, i >> 4);
        const uint record = find_record(params.grid, params.edge_shift, voxel);
        if (record != kNoRecord)
            look_at_record(nearest, point, record, packed_records[record], point.at_vox - vec3(voxel));
    }
    return filled(found, nearest, packed_records[nearest.known == kNoRecord ? 0u : nearest.known]);
}

void main() {
    const uint index = gl_GlobalInvocationID.x;
    if (index >= params.points) return;
    const uint first = 3u * index;
    const vec3 position_m = vec3(positions_m[first], positions_m[first + 1u], positions_m[first + 2u]);
    const vec3 normal = vec3(normals[first], normals[first + 1u], normals[first + 2u]);
    // Without a viewer, a point without a normal belongs to no record.
    const SurfacePoint point = SurfacePoint(position_m / params.grid.voxel_m - 0.5, normal, vec3(0.0));
    Reflectance found = interpolate(point);
    if (!found.known) found = fill(point, found);
    const uint label = found.labelled == kNoRecord ? 0u : record_label(records[found.labelled]);
    const bool has_entry = label != 0u && label < params.materials;
    const bool in_records = found.known;
    found = with_segment(found, has_entry ? segment_kd(segments[label]) : vec4(0.0), normal);
    const vec4 kd = found.known ? vec4(found.kd, in_records ? 1.0 : 0.5) : vec4(0.0);
    samples[index] = SampledReflectance(kd, label, 0u, 0u, 0u);
}
