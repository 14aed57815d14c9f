#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// One invocation per voxel that a segment of the batch keeps: two of its views, one of them at random, and the one
// farthest from it. Only unclipped ones that are not flat, where dielectrics reflect like mirrors, too.
#include "lib/records/observations.glsl"
#include "lib/segments/segment_samples.glsl"
#include "shared/specular/mirror_fit.h"

layout(local_size_x = kMirrorGroup) in;
layout(std430, binding = 0) readonly buffer Batch { uint batch[]; };  // count, then labels
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 3) readonly buffer Kept { uint kept[]; };
layout(std430, binding = 4) readonly buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 9) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(std430, binding = 14) writeonly buffer Pairs { MirrorPair pairs[]; };  // kSegmentSamples per segment
layout(push_constant) uniform Push { MirrorParams params; };
#include "lib/records/record_colors.glsl"
#include "lib/records/record_directions.glsl"

const float kLeastCosine = 0.4;  // 66 degrees: there glass reflects 13 %

// Frames of low exposure show what is brighter than pixels of the others can be. What mirrored rays meet ends there,
// too.
bool is_usable(uint word, uint color, vec3 normal) {
    return !any(observation_clipped(word)) && all(lessThanEqual(unpack_shared_exponent(color), vec3(1.0))) &&
           dot(observation_direction(word), normal) > kLeastCosine;
}

MirrorPair choose(uint record) {
    const VoxelRecord known = records[record];
    const vec3 normal = surface_normal(known);
    const uint count = observation_count(known);
    const MirrorPair none = MirrorPair(kNoRecord, 0u, 0u, 0u, vec4(0.0));
    if (count < kFitLeastObservations) return MirrorPair(kNoRecord, kFewViews, 0u, 0u, vec4(0.0));
    const uint first = sample_hash(known, params.stamp) % count;
    const uint word = load_direction(params.records.chunk_shift, record, first);
    const uint color = load_color(params.records.chunk_shift, record, first);
    if (!is_usable(word, color, normal)) return none;
    const vec3 direction = observation_direction(word);
    uint second = first, other = word;
    float nearest = 0.9999;  // 0.8 degrees
    for (uint quad = 0u; 4u * quad < count; ++quad) {
        const uvec4 words = load_directions(params.records.chunk_shift, record, quad);
        const uvec4 seen = load_colors(params.records.chunk_shift, record, quad);
        [[unroll]] for (uint i = 0u; i < 4u; ++i) {
            const uint k = 4u * quad + i;
            const float cosine = dot(observation_direction(words[i]), direction);
            const bool farther = k < count && cosine < nearest && is_usable(words[i], seen[i], normal);
            second = farther ? k : second;
            other = farther ? words[i] : other;
            nearest = farther ? cosine : nearest;
        }
    }
    if (second == first) return none;
    const vec3 a = unpack_shared_exponent(color);
    const vec3 b = unpack_shared_exponent(load_color(params.records.chunk_shift, record, second));
    return MirrorPair(record, word, other, 0u, vec4(a - b, 0.0));
}

void main() {
    const uint segment = gl_GlobalInvocationID.x / kSegmentSamples, slot = gl_GlobalInvocationID.x % kSegmentSamples;
    const uint label = batch[1u + segment];
    const bool have = label < params.labels && slot < counts[min(label, params.labels - 1u)].kept;
    const uint record = have ? kept[label * kSegmentSamples + slot] : kNoRecord;
    MirrorPair pair = MirrorPair(kNoRecord, 0u, 0u, 0u, vec4(0.0));
    if (record != kNoRecord && record_label(records[record]) == label) pair = choose(record);
    pairs[gl_GlobalInvocationID.x] = pair;
}
