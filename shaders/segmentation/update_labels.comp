#version 460
#extension GL_GOOGLE_include_directive : require
// Each pixel that speaks for a voxel gives it the label of its segment. And the label of each pixel: what the map says,
// else what its segment got.
#include "lib/voxel_chunks.glsl"
#include "lib/voxel_labels.glsl"

layout(local_size_x = kLabelGroupX, local_size_y = kLabelGroupY) in;
layout(binding = 0, r32ui) uniform readonly uimage2D segment;
layout(binding = 1, r32ui) uniform readonly uimage2D map_label;
layout(binding = 2, r32ui) uniform readonly uimage2D voxel;
layout(binding = 3, r32ui) uniform readonly uimageBuffer Parents;
layout(binding = 4, r32ui) uniform readonly uimageBuffer SegmentLabels;
layout(binding = 5, r32ui) uniform writeonly uimage2D label;
layout(std430, binding = 6) buffer Words { uint items[]; }
words[kMaxVoxelChunks];
layout(std430, binding = 11) buffer Counters { SegmentCounters counters; };
layout(push_constant) uniform Push { UpdateLabelsParams params; };

shared uint voted;
shared uint flipped;

void vote(uint found, uint root, uint assigned, uvec2 pixel) {
    const uint block = found / kBlockVoxels;
    const uint index = index_in_chunk(params.chunk_shift, block) * kBlockVoxels + found % kBlockVoxels;
    uint word;
#define LOAD_WORD(C) word = words[C].items[index]
#define STORE_WORD(C) words[C].items[index] = next
    WITH_CHUNK(params.chunk_shift, block, LOAD_WORD)
    if (word_tag(word) != pixel_tag(pixel)) return;
    const uint known = root == kNoLabel ? 0u : label_word(root, label_confidence(word));
    const uint next = assigned == kNoLabel ? known : voted_word(known, assigned);
    WITH_CHUNK(params.chunk_shift, block, STORE_WORD)
    if (assigned != kNoLabel) atomicAdd(voted, 1u);
    if (root != kNoLabel && voxel_label(next) != root) atomicAdd(flipped, 1u);
}

void main() {
    if (gl_LocalInvocationIndex == 0u) {
        voted = 0u;
        flipped = 0u;
    }
    barrier();
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(pixel, imageSize(segment)))) {
        // Labels may have merged since the map was sampled.
        const uint root = imageLoad(Parents, int(imageLoad(map_label, pixel).x)).x;
        const uint assigned = imageLoad(SegmentLabels, int(imageLoad(segment, pixel).x)).x;
        imageStore(label, pixel, uvec4(root != kNoLabel ? root : assigned));
        const uint found = imageLoad(voxel, pixel).x;
        if (found != kNoVoxel) vote(found, root, assigned, uvec2(pixel));
    }
    barrier();
    if (gl_LocalInvocationIndex == 0u && voted > 0u) atomicAdd(counters.frame_voxels, voted);
    if (gl_LocalInvocationIndex == 0u && flipped > 0u) atomicAdd(counters.frame_flips, flipped);
}
