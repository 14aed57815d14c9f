// Mean-shift with a flat kernel (Comaniciu and Meer 2002): moves each seed to the centre of the luminous mass around
// it, in space for emitters with depth, on the sphere of bearings for those without.
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

const uint kMaxIterations = 12u;
const float kStill = 1e-5;  // a shift by less than this share of the kernel is the last

shared vec4 partial[kMeanShiftGroup];

// Emitters of one kind are compared; those of the other lie at infinity.
vec3 point_of(Emitter e, vec3 camera_m) {
    return e.bearing_range.w > 0.0 ? camera_m + e.bearing_range.w * e.bearing_range.xyz : e.bearing_range.xyz;
}

// Whether an emitter at this offset from a mode counts for it.
bool is_inside(Emitter e, vec3 offset, bool has_depth) {
    const float bandwidth = has_depth ? params.bandwidth_m : params.bandwidth_chord;
    return (e.bearing_range.w > 0.0) == has_depth && dot(offset, offset) <= bandwidth * bandwidth;
}

vec4 sum_of_group(vec4 own) {
    const uint lane = gl_LocalInvocationIndex;
    partial[lane] = own;
    barrier();
    for (uint reach = kMeanShiftGroup / 2u; reach > 0u; reach /= 2u) {
        if (lane < reach) partial[lane] += partial[lane + reach];
        barrier();
    }
    const vec4 sum = partial[0];
    barrier();
    return sum;
}

void main() {
    const uint lane = gl_LocalInvocationIndex, seed = gl_WorkGroupID.x;
    const uint count = min(places[params.group_count], kMaxEmitters);
    const uint seeds = min(count, kMeanShiftSeeds);
    if (seed >= seeds) {
        if (lane == 0u) modes[seed] = EmitterMode(vec4(0.0), 0.0, 0u, 0.0, 0u);
        return;
    }
    const vec3 camera_m = camera_center_m(params.camera);
    const Emitter start = emitters[count > kMeanShiftSeeds ? seed * count / kMeanShiftSeeds : seed];
    const bool has_depth = start.bearing_range.w > 0.0;
    vec3 mode = point_of(start, camera_m);
    float weight = 0.0;
    for (uint i = 0u; i < kMaxIterations; ++i) {
        vec4 own = vec4(0.0);
        for (uint k = lane; k < count; k += kMeanShiftGroup) {
            const Emitter e = emitters[k];
            const vec3 offset = point_of(e, camera_m) - mode;
            // Sums of offsets keep more digits than sums of points.
            if (is_inside(e, offset, has_depth)) {
                own += vec4(offset, 1.0) * (luminance(e.radiance_angle.rgb) * e.radiance_angle.w);
            }
        }
        const vec4 sum = sum_of_group(own);
        const vec3 shift = sum.xyz / max(sum.w, 1e-30);
        mode += shift;
        weight = sum.w;
        if (length(shift) <= kStill * params.bandwidth_m) break;
    }
    float own_sr = 0.0;
    for (uint k = lane; k < count; k += kMeanShiftGroup) {
        const Emitter e = emitters[k];
        if (is_inside(e, point_of(e, camera_m) - mode, has_depth)) own_sr += e.radiance_angle.w;
    }
    const float angle_sr = sum_of_group(vec4(own_sr)).x;
    if (!has_depth) mode = normalize(mode);
    if (lane == 0u) modes[seed] = EmitterMode(vec4(mode, 0.0), weight, has_depth ? 1u : 0u, angle_sr, 0u);
}
