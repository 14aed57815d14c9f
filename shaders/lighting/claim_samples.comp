#version 460
#extension GL_GOOGLE_include_directive : require
// Records compete for the places of the samples of the surface, and for those of its highlights behind them.
#include "shared/lighting/fit_lights.h"
layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer RecordCounters { MapCounters counters; };
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) buffer Claims { uint claims[]; };
layout(std430, binding = 4) readonly buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 9) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(push_constant) uniform Push { SampleParams params; };
#include "lighting/sample_surface.glsl"

void main() {
    const uint record = gl_GlobalInvocationID.x;
    if (record >= counters.high_water) return;
    const VoxelRecord known = records[record];
    if (!is_candidate(known)) return;
    const Claim claim = claim_of(known), highlight = highlight_claim_of(known);
    atomicMax(claims[claim.place], claim.priority);
    if (sample_of(record, known).highlight.w > 0.0) atomicMax(claims[highlight.place], highlight.priority);
}
