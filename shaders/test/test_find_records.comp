#version 460
#extension GL_GOOGLE_include_directive : require
// Looks up the records of a list of voxels.
#include "shared/test/test_observations.h"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Voxels { ivec4 voxels[]; };
layout(std430, binding = 1) readonly buffer Keys { uvec4 keys[]; };
layout(std430, binding = 2) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 3) readonly buffer RecordTable { uint record_table[]; };
layout(std430, binding = 4) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 5) writeonly buffer Found { VoxelRecord found[]; };
layout(push_constant) uniform Push { TestObservationParams params; };
#define KEYS(bucket) keys[bucket]
#define BLOCK(slot) blocks[slot]
#define RECORD(entry) record_table[entry]
#include "lib/records/find_record.glsl"

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.records) return;
    const uint record = find_record(params.grid, params.step, voxels[i].xyz);
    VoxelRecord content = VoxelRecord(kEmptyKey, 0u, 0u, 0u);
    if (record != kNoRecord) content = records[record];
    found[i] = content;
}
