#ifndef PATINA_LIB_KINECT2_UNWRAP_GLSL
#define PATINA_LIB_KINECT2_UNWRAP_GLSL
#include "lib/math/atan2.glsl"
#include "shared/kinect2/infrared.h"

// How far light went, from its phase at three frequencies.

const vec3 kWraps = vec3(3.0, 15.0, 2.0);  // of 80, 16 and 120 MHz, in units of 1.25 m of travel
const vec3 kFrequencies = vec3(0.55131784, 0.11026357, 0.82697676);  // (80, 16, 120) to length 1

// A phase in turns, 0 to 1.
float turns(float along, float across) {
    const float turn = atan2_precise(across, along) * (0.5 / kPi);
    return turn < 0.0 ? turn + 1.0 : turn;
}

// The turns of all three frequencies since the light left, from their fractions. The lowest frequency knows which turn
// of the first it is, and both know which turn of the last.
vec3 unwrapped(vec3 fraction) {
    const vec3 t = fraction * kWraps;
    const float first = 3.0 * floor((t.y - t.x) / 3.0 + 0.5) + t.x;
    const float rest = 2.0 * fract(0.5 * abs(first - t.z));
    // Where first and last disagree by half a turn, the light came from the second half of the range.
    const float half_range = rest > 0.5 && rest < 1.5 ? 15.0 : 0.0;
    const float far = first + half_range;
    const float last = 2.0 * floor(0.5 * (far - t.z) + 0.5) + t.z;
    return vec3(far, t.y + half_range, last) / kWraps;
}

// How far the turns are from those of any one distance, squared, as an angle.
float residual(vec3 counted) {
    const vec3 off = cross(2.0 * kPi * counted, kFrequencies);
    return dot(off, off);
}

// From the mean of the turns to mm along z. `ray`: its x at z = 1, and mm along z for one turn. The light comes from
// beside the camera.
float depth_of(float mean, vec2 ray) {
    const float along = ray.y * mean;
    const float travel = 2.0 * kUnambiguous * mean;
    if (travel <= 0.0 || along <= 0.0) return 0.0;
    return max(along / (1.0 - along * ray.x * kEmitterBaseline / (travel * travel)), 0.0);
}

#endif
