#version 460
#extension GL_GOOGLE_include_directive : require
// Records that got a place in the samples of the surface, or of its highlights, are written there.
#include "shared/lighting/fit_lights.h"
#include "shared/reflectance/reflectance.h"
layout(local_size_x = kRecordGroup) in;
layout(std430, binding = 0) readonly buffer RecordCounters { MapCounters counters; };
layout(std430, binding = 1) readonly buffer Records { VoxelRecord records[]; };
layout(std430, binding = 2) readonly buffer Claims { uint claims[]; };
layout(std430, binding = 3) writeonly buffer Samples { LightSample samples[]; };
layout(std430, binding = 4) readonly buffer Directions { uvec4 quads[]; }
directions[kMaxVoxelChunks];
layout(std430, binding = 9) readonly buffer Colors { uvec4 quads[]; }
colors[kMaxVoxelChunks];
layout(std430, binding = 14) readonly buffer Status { RecordStatus status[]; };
layout(push_constant) uniform Push { SampleParams params; };
#include "lib/lighting/surroundings.glsl"
#include "lib/records/gathered_light.glsl"
#include "lighting/sample_surface.glsl"

vec4 light_around(uint record) {
    const GatheredLight light = unpack_gathered(status[record].incident);
    const float rays = light.met + light.missed;
    return rays > 0.0 ? vec4(light.mean * light.met, light.missed) / rays : vec4(0.0, 0.0, 0.0, -1.0);
}

// As low exposure showed it, where it is brighter than the usual one shows.
vec3 unclipped(vec3 color, uint bright) {
    return max(max(color.r, color.g), color.b) > kNearlyClipped ? max(color, unpack_shared_exponent(bright)) : color;
}

void main() {
    const uint record = gl_GlobalInvocationID.x;
    if (record >= counters.high_water) return;
    const VoxelRecord known = records[record];
    if (!is_candidate(known)) return;
    const Claim claim = claim_of(known), highlight = highlight_claim_of(known);
    const bool is_sample = claims[claim.place] == claim.priority;
    const bool is_highlight = claims[highlight.place] == highlight.priority;
    if (!is_sample && !is_highlight) return;
    LightSample drawn = sample_of(record, known);
    drawn.diffuse.rgb = unclipped(drawn.diffuse.rgb, status[record].bright);
    drawn.around = light_around(record);
    if (is_sample) samples[claim.place] = drawn;
    if (is_highlight) samples[highlight.place] = drawn;
}
