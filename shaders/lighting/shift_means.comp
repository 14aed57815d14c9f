// Moves each seed to the centre of the luminous mass around it, in space for emitters with depth, on the sphere of
// bearings for those without.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/camera/camera.glsl"
#include "shared/lighting/find_lights.h"

layout(local_size_x = kMeanShiftGroup) in;
layout(std140, binding = 0) uniform Params { FindLightsParams params; };
layout(std430, binding = 1) readonly buffer Places { uint places[]; };
layout(std430, binding = 2) readonly buffer Emitters { Emitter emitters[]; };
layout(std430, binding = 3) writeonly buffer Modes { EmitterMode modes[]; };
#include "lib/color/luminance.glsl"
#include "mean_shift.glsl"

void main() {
    const uint lane = gl_LocalInvocationIndex, seed = gl_WorkGroupID.x;
    const uint count = min(places[params.group_count], kMaxEmitters);
    const uint seeds = min(count, kMeanShiftSeeds);
    if (seed >= seeds) {
        if (lane == 0u) modes[seed] = EmitterMode(vec4(0.0), 0.0, 0u, 0.0, 0.0);
        return;
    }
    const vec3 camera_m = camera_center_m(params.camera);
    const Emitter start = emitters[count > kMeanShiftSeeds ? seed * count / kMeanShiftSeeds : seed];
    const bool has_depth = start.bearing_range.w > 0.0;
    const float reach = has_depth ? params.bandwidth_m : params.bandwidth_chord;
    const EmitterMode mode = shifted(point_of(start, camera_m), has_depth, reach, camera_m, count);
    if (lane == 0u) modes[seed] = mode;
}
