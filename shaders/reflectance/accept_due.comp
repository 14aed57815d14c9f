#version 460
#extension GL_GOOGLE_include_directive : require
// Takes about params.most of the records that wait for marching. A hash of the voxel and the update chooses, so that
// none waits for ever and record ids do not matter.
#include "lib/records/observations.glsl"
#include "lib/records/record_hash.glsl"
#include "lib/records/record_list.glsl"
#include "shared/reflectance/reflectance.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Waiting { uint waiting[]; };
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) buffer March { uint march[]; };
layout(std430, binding = 3) buffer MarchArguments { uint march_arguments[]; };
layout(push_constant) uniform Push { AcceptParams params; };

void main() {
    const uint count = waiting[0];
    const uint item = gl_GlobalInvocationID.x;
    if (item >= count) return;
    const float share = float(params.most) / float(count);
    const uint bins = clamp(uint(min(share, 1.0) * float(kAcceptBins)), 1u, kAcceptBins);
    const uint record = waiting[1u + item];
    const uint hash = hash_of_voxel(records[record].block_key, voxel_in_block(records[record]));
    if (hash_of_key(hash + params.stamp) % kAcceptBins < bins) APPEND_RECORD(march, march_arguments, record)
}
