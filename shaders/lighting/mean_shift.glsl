// Mean-shift with a flat kernel (Comaniciu and Meer 2002) over a frame's emitters, by a whole group of kMeanShiftGroup
// invocations. Expects `emitters` and luminance().

#include "sum_of_group.glsl"

const uint kMaxIterations = 12u;
const float kStill = 1e-5;  // a shift by less than this share of the kernel is the last

// Emitters of one kind are compared; those of the other lie at infinity.
vec3 point_of(Emitter e, vec3 camera_m) {
    return e.bearing_range.w > 0.0 ? camera_m + e.bearing_range.w * e.bearing_range.xyz : e.bearing_range.xyz;
}

// Whether an emitter at this offset from a mode counts for it.
bool is_inside(Emitter e, vec3 offset, bool has_depth, float reach) {
    return (e.bearing_range.w > 0.0) == has_depth && dot(offset, offset) <= reach * reach;
}

// Where the mean-shift from a place ends, with a kernel of that radius, over the first `count` emitters.
EmitterMode shifted(vec3 place, bool has_depth, float reach, vec3 camera_m, uint count) {
    const uint lane = gl_LocalInvocationIndex;
    float weight = 0.0;
    for (uint i = 0u; i < kMaxIterations; ++i) {
        vec4 own = vec4(0.0);
        for (uint k = lane; k < count; k += kMeanShiftGroup) {
            const Emitter e = emitters[k];
            const vec3 offset = point_of(e, camera_m) - place;
            // Sums of offsets keep more digits than sums of points.
            if (is_inside(e, offset, has_depth, reach)) {
                own += vec4(offset, 1.0) * (luminance(e.radiance_angle.rgb) * e.radiance_angle.w);
            }
        }
        const vec4 sum = sum_of_group(own);
        const vec3 shift = sum.xyz / max(sum.w, 1e-30);
        place += shift;
        weight = sum.w;
        if (length(shift) <= kStill * reach) break;
    }
    float own_sr = 0.0;
    for (uint k = lane; k < count; k += kMeanShiftGroup) {
        const Emitter e = emitters[k];
        if (is_inside(e, point_of(e, camera_m) - place, has_depth, reach)) own_sr += e.radiance_angle.w;
    }
    const float angle_sr = sum_of_group(vec4(own_sr)).x;
    return EmitterMode(vec4(has_depth ? place : normalize(place), 0.0), weight, has_depth ? 1u : 0u, angle_sr, reach);
}
