#version 460
#extension GL_GOOGLE_include_directive : require
// Counts the eligible records of each segment by level: those with enough observations, and the others.
#include "lib/segments/segment_samples.glsl"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer RecordCounters { MapCounters counters; };
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) buffer Levels { uint levels[]; };  // twice kSampleLevels per label
layout(push_constant) uniform Push { SampledPart part; };

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= counters.high_water) return;
    const VoxelRecord record = records[item];
    if (!is_eligible(record, part)) return;
    const uint level = sample_level(sample_hash(record, part.samples.seed));
    const uint table = 2u * record_label(record) + (is_sparsely_observed(record, part) ? 1u : 0u);
    atomicAdd(levels[table * kSampleLevels + level], 1u);
}
