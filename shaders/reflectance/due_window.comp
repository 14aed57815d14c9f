#version 460
#extension GL_GOOGLE_include_directive : require
// Lists what is due of the records in a window of the table that moves on with every update. A window of the table,
// which is in the order of hashes, holds the same voxels in every run, as record ids would not. What throws a shadow on
// a record may have changed, so that a share of the window is marched again; it shrinks with the number of records that
// changed in this frame, since little changed then.
#include "lib/records/observations.glsl"
#include "lib/records/record_hash.glsl"
#include "reflectance/due_main.glsl"

layout(local_size_x = kWindowGroup) in;
layout(std430, binding = 8) readonly buffer Keys { uint keys[]; };
layout(std430, binding = 9) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 10) readonly buffer RecordTable { uvec4 record_table[]; };
layout(std430, binding = 11) readonly buffer RecordCounters { MapCounters record_counters; };
layout(std430, binding = 12) buffer Cursors { RefreshCursors cursors; };
layout(std430, binding = 13) readonly buffer ChangedList { uint changed_list[]; };

const uint kShareSteps = 1024u;

uint refreshed_steps;  // of kShareSteps

void list_for_marching(uint record, bool marched) { APPEND_RECORD(march, march_arguments, record) }

void consider_quad(uvec4 entries) {
    for (uint i = 0u; i < 4u; ++i) {
        const uint record = entries[i];
        if (record >= kNewRecord) continue;
        const uint hash = hash_of_voxel(records[record].block_key, voxel_in_block(records[record]));
        consider(record, false, hash_of_key(hash + params.stamp) % kShareSteps < refreshed_steps);
    }
}

bool has_turn(uint key) {
    const vec3 center_m = (vec3(block_of_key(params.voxels, key)) + 0.5) * (params.voxels.voxel_m * float(kBlockEdge));
    return all(lessThanEqual(abs(center_m - params.cube_m.xyz), vec3(params.cube_m.w)));
}

void main() {
    const uint mask = params.records.bucket_mask;
    const uint records_in_use = record_counters.capacity - record_counters.free_blocks;
    const float share = float(params.refreshed) / float(max(records_in_use, 1u));
    const uint window = clamp(uint(min(share, 1.0) * float(mask + 1u)), 1u, params.max_window);
    const uint parity = params.stamp & 1u;
    const uint cursor = cursors.window[parity];
    const uint item = gl_GlobalInvocationID.x;
    if (item == 0u) cursors.window[parity ^ 1u] = (cursor + window) & mask;

    // A full bucket's keys lie in those behind it.
    if (item / kBucketSlots >= min(window + kMaxProbes - 1u, mask + 1u)) return;
    const uint slot = (cursor * kBucketSlots + item) & (mask * kBucketSlots + kBucketSlots - 1u);
    const uint key = keys[slot];
    if (key == kEmptyKey || ((hash_of_key(key) - cursor) & mask) >= window || !has_turn(key)) return;
    const uint block = blocks[slot];
    if (block == kNoBlock) return;
    const float busy = float(changed_list[0]) / kBusyChanges;
    refreshed_steps = uint(clamp(busy, params.least_share, 1.0) * float(kShareSteps));
    const uint quads = 1u << (3u * params.edge_shift - 2u);
    for (uint quad = 0u; quad < quads; ++quad) consider_quad(record_table[block * quads + quad]);
}
