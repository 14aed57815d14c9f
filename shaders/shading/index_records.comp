#version 460
#extension GL_GOOGLE_include_directive : require
// Finds the records in the blocks that a view's grid holds, once per block instead of for each pixel. One invocation
// per block of the voxel map.
#include "lib/camera/view_grid.glsl"
#include "shared/shading/predict_radiance.h"

layout(local_size_x = kVisibleGroup) in;
layout(std140, binding = 0) uniform View { ViewParams view; };
layout(std430, binding = 1) readonly buffer ViewGrid { uint view_grid[]; };
layout(std430, binding = 2) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 3) readonly buffer Counters { MapCounters counters; };
layout(std430, binding = 4) readonly buffer Keys { uvec4 keys[]; };
layout(std430, binding = 5) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 6) readonly buffer RecordTable { uvec4 record_table[]; };
layout(std430, binding = 7) writeonly buffer Entries {
    uvec4 entries[];
};  // by voxel of each block: record or kNoRecord
layout(push_constant) uniform Push { IndexRecordsParams params; };
#define KEYS(bucket) keys[bucket]
#define BLOCK(slot) blocks[slot]
#include "lib/map/block_lookup.glsl"

void main() {
    const uint block = gl_GlobalInvocationID.x;
    if (block >= counters.high_water) return;
    const uint key = block_keys[block];
    if (key == kEmptyKey) return;
    const ivec3 coordinates = block_of_key(params.voxels, key);
    const uint cell = view_grid_cell(view.grid_low.xyz, view.grid_size.xyz, coordinates);
    if (cell == kOutsideGrid || view_grid[cell] != block) return;

    const uint quads = 1u << 3u * params.edge_shift >> 2u;
    const uint observed = find_block(params.records, coordinates);
    for (uint i = 0u; i < quads; ++i) {
        uvec4 quad = observed == kNoBlock ? uvec4(kNoRecord) : record_table[observed * quads + i];
        quad = mix(uvec4(kNoRecord), quad, lessThan(quad, uvec4(kNewRecord)));
        entries[block * quads + i] = quad;
    }
}
