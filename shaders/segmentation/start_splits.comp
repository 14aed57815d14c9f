#version 460
#extension GL_GOOGLE_include_directive : require
// Gives each label that is to be split a partner, in the order of labels, and says whether any has one. One workgroup.
#include "lib/map/voxel_map.glsl"
#include "shared/segmentation/split_labels.h"

layout(local_size_x = kSplitGroup) in;
layout(std430, binding = 0) readonly buffer Proposals { SplitProposal proposals[]; };
layout(std430, binding = 1) buffer Parents { uint parents[]; };
layout(std430, binding = 2) buffer Labels { SegmentLabel labels[]; };
layout(std430, binding = 3) coherent buffer Partners { uint partners[]; };
layout(std430, binding = 4) buffer Rules { SplitRule rules[]; };
layout(std430, binding = 5) readonly buffer FreeLabels { uint free_labels[]; };
layout(std430, binding = 6) buffer Counters { SegmentCounters counters; };
layout(std430, binding = 7) buffer SegmentKds { SegmentKd kds[]; };
layout(std430, binding = 8) readonly buffer VoxelCounters { MapCounters voxel_counters; };
layout(std430, binding = 9) readonly buffer RecordCounters { MapCounters record_counters; };
layout(std430, binding = 10) writeonly buffer VoxelArguments { uvec4 voxel_arguments; };
layout(std430, binding = 11) writeonly buffer RecordArguments { uvec4 record_arguments; };
layout(push_constant) uniform Push { StartSplitsParams params; };

const uint kGroup = kSplitGroup;
#include "lib/segments/in_order.glsl"

shared uint paired;

// What is known of either colour alone has yet to be seen.
void begin(uint label, uint partner, SplitRule rule) {
    SegmentLabel known = labels[label];
    known.state = kLiveLabel;
    known.since = params.stamp;
    known.chroma_samples = known.chroma_r = known.chroma_g = 0u;
    labels[label] = known;
    kds[label] = SegmentKd(0u, 0u, 0u, 0u);
    parents[label] = label;
    partners[label] = partner;
    rules[label] = rule;
}

void split(uint label, uint beyond, SplitRule rule) {
    begin(label, beyond, rule);
    labels[beyond] = SegmentLabel(kLiveLabel, params.stamp, labels[label].seen, 0u, 0u, 0u, 0u, 0u);
    rule.beyond = 1u;
    begin(beyond, label, rule);
    atomicMax(counters.high_water, beyond + 1u);
}

void main() {
    if (gl_LocalInvocationIndex == 0u) paired = 0u;
    const uint count = min(counters.high_water, params.labels) - 1u;
    const uint available = counters.free_labels, head = counters.free_head, capacity = counters.capacity;
    const uvec2 own = own_items(count);
    uint wanted = 0u;
    for (uint label = own.x; label < own.y; ++label) wanted += proposals[label].beyond > 0u ? 1u : 0u;
    uint total;
    uint next = sum_before(wanted, total);
    for (uint label = own.x; label < own.y; ++label) {
        if (proposals[label].beyond > 0u && next++ < available)
            split(label, free_labels[(head + next - 1u) % capacity], proposals[label].rule);
    }
    memoryBarrierBuffer();
    barrier();
    for (uint label = own.x; label < own.y; ++label) {
        if (partners[label] != kNoLabel && partners[label] != label) atomicOr(paired, 1u);
    }
    barrier();
    if (gl_LocalInvocationIndex != 0u) return;
    const uint granted = min(total, available);
    counters.free_head = (head + granted) % capacity;
    counters.free_labels = available - granted;
    counters.live += granted;
    counters.created += granted;
    counters.split += granted;
    counters.refused += total - granted;
    voxel_arguments = uvec4(paired * ((voxel_counters.high_water + kSweepGroup - 1u) / kSweepGroup), 1u, 1u, 0u);
    record_arguments = uvec4(paired * ((record_counters.high_water + kRecordGroup - 1u) / kRecordGroup), 1u, 1u, 0u);
}
