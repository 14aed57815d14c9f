#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// How well the records around each surface point are known: their observations, and how certain their albedo is.
#include "lib/camera/view_grid.glsl"
#include "lib/records/observations.glsl"
#include "lib/records/packed_records.glsl"
#include "shared/fusion/visible_blocks.h"
#include "shared/shading/sample_coverage.h"
layout(local_size_x = kSampleCoverageGroup, local_size_y = kSampleCoverageGroup) in;
layout(binding = 0, rgba32f) uniform readonly image2D position_m;
layout(binding = 1, rgba16f) uniform writeonly image2D coverage;
layout(std140, binding = 2) uniform View { ViewParams view; };
layout(std430, binding = 3) readonly buffer ViewGrid { uint view_grid[]; };
layout(std430, binding = 4) readonly buffer Entries { uint entries[]; };
layout(std430, binding = 5) readonly buffer Packed { uvec4 content[]; };
layout(std430, binding = 6) readonly buffer Records { VoxelRecord records[]; };
layout(push_constant) uniform Push { SampleCoverageParams params; };

uint record_at(ivec3 voxel) {
    const uint cell = view_grid_cell(view.grid_low.xyz, view.grid_size.xyz, voxel >> int(params.edge_shift));
    const uint block = cell == kOutsideGrid ? kNoBlock : view_grid[cell];
    if (block == kNoBlock) return kNoRecord;
    return entries[block << 3u * params.edge_shift | voxel_number(voxel, params.edge_shift)];
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(position_m)))) return;
    const vec4 point = imageLoad(position_m, pixel);
    const vec3 at_vox = point.xyz / params.voxel_m - 0.5;
    const ivec3 low = ivec3(floor(at_vox));
    const vec3 t = at_vox - vec3(low);
    vec3 sum = vec3(0.0);  // observations, certainty, share
    for (int i = 0; i < 8 && point.w > 0.0; ++i) {
        const ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
        const uint record = record_at(low + corner);
        if (record == kNoRecord) continue;
        const vec3 shares = mix(1.0 - t, t, vec3(corner));
        const vec3 certain = packed_certainty(content[record]);
        const float least = min(certain.r, min(certain.g, certain.b));
        sum += shares.x * shares.y * shares.z * vec3(float(observation_count(records[record])), least, 1.0);
    }
    const vec2 known = sum.z > 0.0 ? sum.xy / sum.z : vec2(0.0);
    imageStore(coverage, pixel, vec4(known, 0.0, point.w > 0.0 ? 1.0 : 0.0));
}
