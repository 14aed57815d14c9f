#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Adds one observation to every record, from a stream of its own. Its colour is its number in the stream.
#include "lib/map/voxel_chunks.glsl"
#include "lib/records/record_list.glsl"
#include "shared/test/test_observations.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Streams { uint streams[]; };  // direction words, step by step
layout(std430, binding = 1) buffer Counts { uint counts[]; };
layout(std430, binding = 2) buffer Stale { uint stale[]; };
layout(std430, binding = 3) buffer StaleArguments { uint stale_arguments[]; };
layout(std430, binding = 4) buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 9) buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(push_constant) uniform Push { TestObservationParams params; };
#include "observation/insert_observation.glsl"

void main() {
    const uint record = gl_GlobalInvocationID.x;
    if (record >= params.records) return;
    const vec3 direction = observation_direction(streams[params.step * params.records + record]);
    const Insertion insertion = insert_observation(params.grid.chunk_shift, record, counts[record], direction,
                                                   vec3(float(params.step)), bvec3(false), params.merge_distance2);
    if (insertion.lost_closest) APPEND_RECORD(stale, stale_arguments, record)
    counts[record] = insertion.count;
}
