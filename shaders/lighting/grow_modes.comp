// Lets the kernel of each candidate grow until it holds the whole lamp.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera/camera.glsl"
#include "shared/lighting/find_lights.h"

layout(local_size_x = kMeanShiftGroup) in;
layout(std140, binding = 0) uniform Params { FindLightsParams params; };
layout(std430, binding = 1) readonly buffer Places { uint places[]; };
layout(std430, binding = 2) readonly buffer Emitters { Emitter emitters[]; };
layout(std430, binding = 3) readonly buffer Candidates { EmitterMode candidates[]; };
layout(std430, binding = 4) writeonly buffer Grown { EmitterMode grown[]; };
#include "lib/color/luminance.glsl"
#include "mean_shift.glsl"

// A lamp reaches beyond the kernel if the kernel's outer rings, each a quarter wider than the one within, all shine,
// nearly as bright as the rest: another lamp beside it, or its image in a mirror, leaves a gap. Rings are those of the
// picture: readings between a lamp and what is behind it fill none. What reaches beyond the largest kernel is a window
// or a wall: the candidate stays as it was.
const uint kMaxGrowths = 6u;  // to 0.57 m
const float kGrowth = 1.25;
const float kLeastRing = 0.05;  // of the solid angle within the kernel
const float kNearlyAsBright = 0.5;

bool reaches_beyond(EmitterMode mode, vec3 camera_m, uint count) {
    const bool has_depth = mode.has_depth != 0u;
    const vec3 toward = has_depth ? normalize(mode.point.xyz - camera_m) : mode.point.xyz;
    const float bright = kNearlyAsBright * mode.weight / max(mode.angle_sr, 1e-30);
    vec4 rings_sr = vec4(0.0);  // from the outermost one on
    for (uint k = gl_LocalInvocationIndex; k < count; k += kMeanShiftGroup) {
        const Emitter e = emitters[k];
        const vec3 offset = point_of(e, camera_m) - mode.point.xyz;
        if (!is_inside(e, offset, has_depth, mode.reach) || luminance(e.radiance_angle.rgb) < bright) continue;
        const float across = length(cross(offset, toward));
        const int ring = int(log2(mode.reach / max(across, 1e-6)) / log2(kGrowth));
        if (ring < 4) rings_sr[ring] += e.radiance_angle.w;
    }
    return all(greaterThan(sum_of_group(rings_sr), vec4(kLeastRing * mode.angle_sr)));
}

void main() {
    const uint count = min(places[params.group_count], kMaxEmitters);
    const vec3 camera_m = camera_center_m(params.camera);
    const EmitterMode candidate = candidates[gl_WorkGroupID.x];
    EmitterMode mode = candidate;
    bool beyond = candidate.weight > 0.0 && reaches_beyond(candidate, camera_m, count);
    for (uint i = 0u; i < kMaxGrowths && beyond; ++i) {
        mode = shifted(mode.point.xyz, mode.has_depth != 0u, mode.reach * kGrowth, camera_m, count);
        beyond = reaches_beyond(mode, camera_m, count);
    }
    if (gl_LocalInvocationIndex == 0u) grown[gl_WorkGroupID.x] = beyond ? candidate : mode;
}
