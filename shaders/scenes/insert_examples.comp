#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// One invocation per voxel: adds what one view shows of it to its observations, as
// observation/collect_observations.comp does.
#include "lib/map/voxel_chunks.glsl"
#include "lib/records/record_list.glsl"
#include "shared/scenes/example_scenes.h"

layout(local_size_x = kExampleGroup) in;
layout(std430, binding = 0) readonly buffer Readings { ExampleReading readings[]; };
layout(std430, binding = 1) buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) buffer Stale { uint stale[]; };
layout(std430, binding = 3) buffer StaleArguments { uint stale_arguments[]; };
layout(std430, binding = 4) buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 9) buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(push_constant) uniform Push { InsertExamplesParams params; };
#include "observation/insert_observation.glsl"

void main() {
    const uint voxel = gl_GlobalInvocationID.x;
    if (voxel >= params.scenes * kExampleVoxels) return;
    const ExampleReading reading = readings[params.view * params.scenes * kExampleVoxels + voxel];
    if (reading.to_viewer.w == 0.0) return;
    VoxelRecord record = records[voxel];
    const uint count = observation_count(record), clipped = uint(reading.rgb.w);
    const Insertion insertion =
        insert_observation(params.chunk_shift, voxel, count, reading.to_viewer.xyz, reading.rgb.rgb,
                           notEqual(clipped & uvec3(1u, 2u, 4u), uvec3(0u)), params.merge_distance2);
    if (insertion.lost_closest) APPEND_RECORD(stale, stale_arguments, voxel)
    record.state = pack_state(insertion.count, voxel_in_block(record), surface_samples(record), 0.0);
    records[voxel] = record;
}
