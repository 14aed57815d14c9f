#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Of the map's blocks, those whose keys have their turn in this frame: replaces labels by their roots, and counts the
// voxels of each. A group looks at kSweepGroup block ids.
#include "lib/map/voxel_chunks.glsl"
#include "lib/map/voxel_labels.glsl"
#include "lib/map/voxel_map.glsl"

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
    uvec4 roots;
    [[unroll]] for (int i = 0; i < 4; ++i) roots[i] = imageLoad(Parents, int(voxel_label(before[i]))).x;
    const uvec4 after = mix((before & ~0xffffu) | roots, uvec4(0u), equal(roots, uvec4(kNoLabel)));
    // Neighbours mostly have one label: they are counted together.
    const bvec4 is_new = bvec4(true, roots.y != roots.x, roots.z != roots.y && roots.z != roots.x,
                               roots.w != roots.z && roots.w != roots.y && roots.w != roots.x);
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const uvec4 same = uvec4(equal(roots, uvec4(roots[i])));
        if (is_new[i] && roots[i] != kNoLabel) atomicAdd(labels[roots[i]].tally, same.x + same.y + same.z + same.w);
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
