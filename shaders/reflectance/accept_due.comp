#version 460
#extension GL_GOOGLE_include_directive : require
// Takes about params.most of the records that wait for marching: those whose hash lies in a range that moves on with
// every update, so that each has its turn.
#include "lib/observations.glsl"
#include "lib/record_hash.glsl"
#include "lib/record_list.glsl"
#include "shared/reflectance.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Waiting { uint waiting[]; };
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) buffer Cursors { RefreshCursors cursors; };
layout(std430, binding = 3) buffer March { uint march[]; };
layout(std430, binding = 4) buffer MarchArguments { uint march_arguments[]; };
layout(push_constant) uniform Push { AcceptParams params; };

void main() {
    const uint count = waiting[0];
    const float share = float(params.most) / float(max(count, 1u));
    const uint bins = clamp(uint(min(share, 1.0) * float(kAcceptBins)), 1u, kAcceptBins);
    const uint parity = params.stamp & 1u;
    const bool never_marched = params.never_marched != 0u;
    const uint cursor = never_marched ? cursors.never_marched[parity] : cursors.changed[parity];
    const uint item = gl_GlobalInvocationID.x;
    if (item == 0u) {
        const uint next = (cursor + bins) % kAcceptBins;
        if (never_marched)
            cursors.never_marched[parity ^ 1u] = next;
        else
            cursors.changed[parity ^ 1u] = next;
    }
    if (item >= count) return;
    const uint record = waiting[1u + item];
    const uint hash = hash_of_voxel(records[record].block_key, voxel_in_block(records[record]));
    if ((hash - cursor) % kAcceptBins < bins) APPEND_RECORD(march, march_arguments, record)
}
