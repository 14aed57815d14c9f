// From three wrapped phases to one depth. An invocation takes some pixels of a column, which share their neighbours:
// software devices are slower with each phasor that is loaded, or stored between two passes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/kinect2/smooth_phasors.glsl"
#include "lib/kinect2/unwrap.glsl"
#include "shared/kinect2/unwrap_phases.h"

layout(local_size_x = 128) in;                      // divides the picture
layout(constant_id = 0) const bool kSmooth = true;  // whether phasors are smoothed first
layout(binding = 0, rgba32f) uniform readonly image2D phasors_ab;
layout(binding = 1, rgba32f) uniform readonly image2D phasors_c;
layout(binding = 2, rgba32f) uniform readonly image2D offsets_c_ray;  // z, w: the ray, as depth_of() takes it
// Depth in mm; amplitude, negative at an edge; infrared.
layout(binding = 3, rgba32f) uniform writeonly image2D readings;
layout(push_constant) uniform Push { UnwrapPhasesParams params; };

const ivec2 kLast = ivec2(kInfraredWidth, kInfraredHeight) - 1;

Phasors phasors_at(ivec2 pixel) {
    const vec4 ab = imageLoad(phasors_ab, pixel), c = imageLoad(phasors_c, pixel);
    return make_phasors(vec3(ab.xz, c.x), vec3(ab.yw, c.y));
}

PhasorRow row_at(ivec2 pixel) {
    PhasorRow row;
    [[unroll]] for (int i = 0; i < 3; ++i) {
        if (kSmooth || i == 1) row.columns[i] = phasors_at(clamp(pixel + ivec2(i - 1, 0), ivec2(0), kLast));
    }
    return row;
}

// Smoothed, but for the picture's border.
Smoothed smoothed(PhasorRow rows[3], bool border) {
    const Phasors center = rows[1].columns[1];
    const Smoothed own = Smoothed(center.along, center.across, vec3(0.0));
    if (!kSmooth) return own;
    const Smoothed inner = smooth_phasors(rows, params.exponent, params.min_square);
    return Smoothed(mix(inner.along, own.along, bvec3(border)), mix(inner.across, own.across, bvec3(border)),
                    mix(inner.distances, own.distances, bvec3(border)));
}

bool plausible(vec3 counted, vec3 amplitudes, float sum) {
    const float smallest = min(amplitudes.x, min(amplitudes.y, amplitudes.z));
    const float largest = max(amplitudes.x, max(amplitudes.y, amplitudes.z));
    const float limit = exp2(params.slope * log2(largest) + params.offset);
    const float clamped = clamp(limit, params.min_residual, params.max_residual);
    return smallest >= params.min_amplitude && sum >= params.min_sum && clamped * clamped >= residual(counted);
}

void store_pixel(ivec2 pixel, PhasorRow rows[3]) {
    const bool border = any(equal(pixel, ivec2(0))) || any(equal(pixel, kLast));
    const Smoothed phasors = smoothed(rows, border);
    const vec3 amplitudes = kAmplitudeScale * sqrt(phasors.along * phasors.along + phasors.across * phasors.across);
    vec3 fraction;
    [[unroll]] for (int f = 0; f < 3; ++f) fraction[f] = turns(phasors.along[f], phasors.across[f]);
    const vec3 counted = unwrapped(fraction);
    const float depth = depth_of((counted.x + counted.y + counted.z) / 3.0, imageLoad(offsets_c_ray, pixel).zw);
    const bool even = all(lessThan(phasors.distances, vec3(params.max_distance)));
    const float sum = amplitudes.x + amplitudes.y + amplitudes.z;
    const float infrared = imageLoad(phasors_c, pixel).z;
    imageStore(readings, pixel,
               vec4(plausible(counted, amplitudes, sum) ? depth : 0.0, even ? sum : -sum, infrared, 0.0));
}

void main() {
    const ivec2 first = ivec2(gl_GlobalInvocationID.xy * uvec2(1u, kUnwrapPhasesRows));
    PhasorRow rows[3];
    if (kSmooth) rows[1] = row_at(first - ivec2(0, 1));
    rows[2] = row_at(first);
    [[unroll]] for (int i = 0; i < int(kUnwrapPhasesRows); ++i) {
        const ivec2 pixel = first + ivec2(0, i);
        rows[0] = rows[1];
        rows[1] = rows[2];
        if (kSmooth || i + 1 < int(kUnwrapPhasesRows)) rows[2] = row_at(pixel + ivec2(0, 1));
        store_pixel(pixel, rows);
    }
}
