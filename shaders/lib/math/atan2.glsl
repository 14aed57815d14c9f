#ifndef PATINA_LIB_ATAN2_GLSL
#define PATINA_LIB_ATAN2_GLSL
#include "lib/math/pi.glsl"

// The angle of (x, y) in [-pi, pi], with an error below 1e-6 on every device, where GLSL allows atan() 4096 ulp. The
// polynomial is Abramowitz and Stegun's 4.4.49. 0 for (0, 0).
float atan2_precise(float y, float x) {
    const float across = abs(x), up = abs(y);
    const float long_side = max(across, up);
    const float t = min(across, up) / max(long_side, 1e-30);
    const float s = t * t;
    float series = 0.0028662257;
    series = series * s - 0.0161657367;
    series = series * s + 0.0429096138;
    series = series * s - 0.0752896400;
    series = series * s + 0.1065626393;
    series = series * s - 0.1420889944;
    series = series * s + 0.1999355085;
    series = series * s - 0.3333314528;
    const float first = t + t * s * series;  // of the octant's angle
    const float quadrant = up > across ? 0.5 * kPi - first : first;
    const float half_turn = x < 0.0 ? kPi - quadrant : quadrant;
    return y < 0.0 ? -half_turn : half_turn;
}

#endif
