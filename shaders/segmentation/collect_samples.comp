#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the records that each segment keeps, in no order, and sums up their albedo.
#include "lib/records/reflectance.glsl"
#include "lib/segments/segment_samples.glsl"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer RecordCounters { MapCounters counters; };
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer Counts { SegmentSampleCount counts[]; };
layout(std430, binding = 3) buffer Filled { uint filled[]; };
layout(std430, binding = 4) writeonly buffer Kept { uint kept[]; };  // kSegmentSamples per label
layout(std430, binding = 5) readonly buffer Albedo { uvec2 albedo[]; };
layout(std430, binding = 6) buffer SegmentKds { SegmentKd kds[]; };
layout(push_constant) uniform Push { SampledPart part; };

void add_kd(uint label, uvec2 stored) {
    const vec3 certainty = albedo_certainty(stored);
    if (min(min(certainty.r, certainty.g), certainty.b) < kLeastKdCertainty) return;
    const uvec3 kd = uvec3(round(clamp(albedo_kd(stored), 0.0, 1.0) * kKdSteps));
    atomicAdd(kds[label].samples, 1u);
    atomicAdd(kds[label].r, kd.r);
    atomicAdd(kds[label].g, kd.g);
    atomicAdd(kds[label].b, kd.b);
}

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= counters.high_water) return;
    const VoxelRecord record = records[item];
    if (!is_eligible(record, part)) return;
    const uint label = record_label(record);
    const uint lowest = is_sparsely_observed(record, part) ? counts[label].sparsely_level : counts[label].level;
    if (sample_level(sample_hash(record, part.samples.seed)) < lowest) return;
    kept[label * kSegmentSamples + atomicAdd(filled[label], 1u)] = item;
    add_kd(label, albedo[item]);
}
