#version 460
#extension GL_GOOGLE_include_directive : require
// One invocation per record that a frame changed: its segment is worth another estimate.
#include "lib/records/observations.glsl"
#include "shared/specular/ward_fit.h"

layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer Changed { uint changed[]; };  // count, then records
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) buffer Progress { SegmentProgress progress[]; };
layout(push_constant) uniform Push { ChooseSegmentsParams params; };

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= changed[0]) return;
    const uint label = record_label(records[changed[1u + item]]);
    if (label < params.labels) atomicAdd(progress[label].changes, 1u);
}
