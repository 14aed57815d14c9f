#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Gives voxels of labels that have a partner to that of the two whose colours are theirs. A group looks at kSweepGroup
// block ids.
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_labels.glsl"
#include "lib/map/voxel_map.glsl"
#include "lib/segments/split_rule.glsl"

layout(local_size_x = kSweepGroup) in;
layout(std430, binding = 0) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 1) readonly buffer Counters { MapCounters counters; };
layout(binding = 2, r32ui) uniform readonly uimageBuffer Partners;
layout(std430, binding = 3) readonly buffer Rules { SplitRule rules[]; };
layout(std430, binding = 4) buffer Words { uvec4 quads[]; }
words[kMaxVoxelChunks];
layout(std430, binding = 9) readonly buffer Color { uvec4 quads[]; }
color[kMaxVoxelChunks];
layout(push_constant) uniform Push { VoxelGrid grid; };

shared uint used[kSweepGroup];
shared uint used_count;

// A merged label still has its partner and rule. To look up roots, too, would take half as long again; sweeps do it.
uint parted(uint word, uint color_word) {
    const uint label = voxel_label(word), partner = imageLoad(Partners, int(label)).x;
    const bool goes = partner != kNoLabel && is_partners(rules[label], voxel_color(color_word));
    return goes ? label_word(partner, word >> 16) : word;
}

void part_quad(uint block, uint quad) {
    uvec4 before, colors;
#define LOAD_WORDS(C) before = words[C].quads[quad]
#define LOAD_COLORS(C) colors = color[C].quads[quad]
#define STORE_WORDS(C) words[C].quads[quad] = after
    WITH_CHUNK(grid.chunk_shift, block, LOAD_WORDS)
    if (before == uvec4(0u)) return;
    WITH_CHUNK(grid.chunk_shift, block, LOAD_COLORS)
    uvec4 after;
    [[unroll]] for (int i = 0; i < 4; ++i) after[i] = parted(before[i], colors[i]);
    if (after != before) {
        WITH_CHUNK(grid.chunk_shift, block, STORE_WORDS)
    }
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) used_count = 0u;
    barrier();
    const uint id = gl_GlobalInvocationID.x;
    if (id < counters.high_water && block_keys[id] != kEmptyKey) used[atomicAdd(used_count, 1u)] = id;
    barrier();
    const uint count = used_count;
    for (uint i = 0u; i < count; ++i) {
        const uint first = index_in_chunk(grid.chunk_shift, used[i]) * (kBlockVoxels / 4u);
        for (uint quad = lane; quad < kBlockVoxels / 4u; quad += kSweepGroup) part_quad(used[i], first + quad);
    }
}
