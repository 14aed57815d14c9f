#version 460
#extension GL_GOOGLE_include_directive : require
// Lists what is due of the records whose blocks' keys lie in a window of hashes that moves on with every update. It is
// made as large as it must be for about as many records as should be looked at, going by what the window before held of
// those that may have a turn. So which records these are depends neither on their ids nor on the size of the table.
// What throws a shadow on a record may have changed, so that a share of the window is marched again; it shrinks with
// the number of records that changed in this frame, since little changed then.
#include "lib/records/observations.glsl"
#include "lib/records/record_hash.glsl"
#include "reflectance/due_main.glsl"

layout(local_size_x = kWindowGroup) in;
layout(std430, binding = 8) readonly buffer Keys { uint keys[]; };
layout(std430, binding = 9) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 10) readonly buffer RecordTable { uvec4 record_table[]; };
layout(std430, binding = 11) buffer Windows { RefreshWindow windows[]; };
layout(std430, binding = 12) readonly buffer ChangedList { uint changed_list[]; };

const uint kShareSteps = 1024u;
const uint kFirstSteps = kWindowSteps / 128u;

uint refreshed_steps;  // of kShareSteps

void list_for_marching(uint record, bool marched){APPEND_RECORD(march, march_arguments, record)}

uint consider_quad(uvec4 entries) {
    uint looked_at = 0u;
    for (uint i = 0u; i < 4u; ++i) {
        const uint record = entries[i];
        if (record >= kNewRecord) continue;
        const uint hash = hash_of_voxel(records[record].block_key, voxel_in_block(records[record]));
        consider(record, false, hash_of_key(hash + params.stamp) % kShareSteps < refreshed_steps);
        ++looked_at;
    }
    return looked_at;
}

bool has_turn(uint key) {
    const vec3 center_m = (vec3(block_of_key(params.voxels, key)) + 0.5) * (params.voxels.voxel_m * float(kBlockEdge));
    return all(lessThanEqual(abs(center_m - params.cube_m.xyz), vec3(params.cube_m.w)));
}

// At most twice as large as the one before, as a small one may happen to hold nothing.
uint window_after(RefreshWindow before) {
    if (params.all != 0u) return params.max_steps;
    if (before.steps == 0u) return kFirstSteps;
    const float wanted = float(before.steps) * (float(params.refreshed) / float(max(before.records, 1u)));
    return clamp(uint(min(wanted, 2.0 * float(before.steps))), 1u, params.max_steps);
}

void main() {
    const RefreshWindow before = windows[(params.stamp + kWindows - 1u) % kWindows];
    const uint first = (before.first + before.steps) % kWindowSteps, steps = window_after(before);
    const uint window = params.stamp % kWindows;
    const uint item = gl_GlobalInvocationID.x;
    if (item == 0u) {
        windows[window].first = first;
        windows[window].steps = steps;
        windows[(params.stamp + 1u) % kWindows].records = 0u;
    }

    // A table of more buckets than steps has several for each, that many apart; one of fewer has one for several. A
    // full bucket's keys lie in those behind it.
    const uint buckets = params.records.bucket_mask + 1u;
    const uint rows = min(buckets, kWindowSteps), columns = buckets / rows;
    const uint row = item / kBucketSlots / columns, column = item / kBucketSlots % columns;
    if (row >= min(steps + kMaxProbes - 1u, rows)) return;
    const uint bucket = column * rows + ((first + row) & (rows - 1u));
    const uint slot = bucket * kBucketSlots + item % kBucketSlots;
    const uint key = keys[slot];
    if (key == kEmptyKey || ((hash_of_key(key) - first) & (kWindowSteps - 1u)) >= steps || !has_turn(key)) return;
    const uint block = blocks[slot];
    if (block == kNoBlock) return;
    const float busy = float(changed_list[0]) / kBusyChanges;
    refreshed_steps = uint(clamp(busy, params.least_share, 1.0) * float(kShareSteps));
    const uint quads = 1u << (3u * params.edge_shift - 2u);
    uint looked_at = 0u;
    for (uint quad = 0u; quad < quads; ++quad) looked_at += consider_quad(record_table[block * quads + quad]);
    atomicAdd(windows[window].records, looked_at);
}
