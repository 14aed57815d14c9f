#version 460
#extension GL_GOOGLE_include_directive : require
// Of the map's blocks, those whose keys have their turn in this frame: replaces labels by their roots, and counts the
// voxels of each. A group looks at kSweepGroup block ids.
#include "lib/voxel_chunks.glsl"
#include "lib/voxel_labels.glsl"
#include "lib/voxel_map.glsl"

layout(local_size_x = kSweepGroup) in;
layout(std430, binding = 0) readonly buffer BlockKeys { uint block_keys[]; };
layout(std430, binding = 1) readonly buffer Counters { MapCounters counters; };
layout(std140, binding = 2) uniform Segmentation { SegmentationParams frame; };
layout(binding = 3, r32ui) uniform readonly uimageBuffer Parents;
layout(std430, binding = 4) buffer Words { uvec4 quads[]; }
words[kMaxVoxelChunks];
layout(std430, binding = 9) buffer Labels { SegmentLabel labels[]; };
layout(push_constant) uniform Push { VoxelGrid grid; };

shared uint due[kSweepGroup];
shared uint due_count;

void sweep_quad(uint block, uint quad) {
    uvec4 before;
#define LOAD_WORDS(C) before = words[C].quads[quad]
#define STORE_WORDS(C) words[C].quads[quad] = after
    WITH_CHUNK(grid.chunk_shift, block, LOAD_WORDS)
    if (before == uvec4(0u)) return;
    uvec4 after;
    for (int i = 0; i < 4; ++i) {
        const uint root = imageLoad(Parents, int(voxel_label(before[i]))).x;
        after[i] = root == kNoLabel ? 0u : (before[i] & ~0xffffu) | root;
        if (root != kNoLabel) atomicAdd(labels[root].tally, 1u);
    }
    if (after != before) {
        WITH_CHUNK(grid.chunk_shift, block, STORE_WORDS)
    }
}

void main() {
    const uint lane = gl_LocalInvocationIndex;
    if (lane == 0u) due_count = 0u;
    barrier();
    const uint id = gl_GlobalInvocationID.x;
    const uint key = id < counters.high_water ? block_keys[id] : kEmptyKey;
    if (key != kEmptyKey && hash_of_key(key) % kSweepParts == frame.stamp / kSweepEvery % kSweepParts)
        due[atomicAdd(due_count, 1u)] = id;
    barrier();
    const uint count = due_count;
    for (uint i = 0u; i < count; ++i) {
        const uint first = index_in_chunk(grid.chunk_shift, due[i]) * (kBlockVoxels / 4u);
        for (uint quad = lane; quad < kBlockVoxels / 4u; quad += kSweepGroup) sweep_quad(due[i], first + quad);
    }
}
