// Random directions and their densities, for light that is gathered by sampling. Functions without bindings. `u` are
// numbers in [0, 1); densities are per steradian.
#ifndef PATINA_LIB_SAMPLING_GLSL
#define PATINA_LIB_SAMPLING_GLSL
#include "lib/ward.glsl"

// The point of the unit circle after so many turns from the x axis, turns in [0, 1], to 3e-7; sin() and cos() may be
// off by 5e-4. Polynomials: Cephes sinf and cosf.
vec2 circle_point(float turns) {
    const float quarter = floor(4.0 * turns + 0.5);
    const float angle = (4.0 * turns - quarter) * 1.57079632679;
    const float z = angle * angle;
    const float s = ((-1.9515295891e-4 * z + 8.3321608736e-3) * z - 1.6666654611e-1) * z * angle + angle;
    const float c =
        ((2.443315711809948e-5 * z - 1.388731625493765e-3) * z + 4.166664568298827e-2) * z * z - 0.5 * z + 1.0;
    const bool odd = quarter == 1.0 || quarter == 3.0;
    const vec2 turned = odd ? vec2(-s, c) : vec2(c, s);
    return quarter == 2.0 || quarter == 3.0 ? -turned : turned;
}

// A right-handed orthonormal basis whose z axis, the last column, is `axis`, of unit length (Duff et al., Building an
// Orthonormal Basis, Revisited, 2017).
mat3 basis_around(vec3 axis) {
    const float s = axis.z < 0.0 ? -1.0 : 1.0;
    const float a = -1.0 / (s + axis.z);
    const float b = axis.x * axis.y * a;
    return mat3(1.0 + s * axis.x * axis.x * a, s * b, -s * axis.x, b, s + axis.y * axis.y * a, -axis.y, axis);
}

// A direction above the plane z = 0, of density z / pi.
vec3 sample_cosine(vec2 u) { return vec3(sqrt(u.x) * circle_point(u.y), sqrt(1.0 - u.x)); }

// A direction of the cap around the z axis of height `cap_height`, which is 1 - the cosine of its half angle; uniform
// in solid angle, 2 pi cap_height. Takes the height because fp32 does not tell a small cap's cosine from 1.
vec3 sample_cap(float cap_height, vec2 u) {
    const float height = u.x * cap_height;
    return vec3(sqrt(height * (2.0 - height)) * circle_point(u.y), 1.0 - height);
}

// A direction to light for the Ward lobe, drawn by way of the half vector (Walter, Notes on the Ward BRDF, 2005, Eq. 6
// to 8). It may lie below the horizon, where the lobe is 0; elsewhere its density is ward_density().
vec3 sample_ward(float alpha, vec3 normal, vec3 to_viewer, vec2 u) {
    const float tan_h = alpha * sqrt(-log(1.0 - u.x));
    const vec3 half_vector =
        basis_around(normal) * (vec3(tan_h * circle_point(u.y), 1.0) * inversesqrt(1.0 + tan_h * tan_h));
    return normalize(2.0 * dot(half_vector, to_viewer) * half_vector - to_viewer);
}

// The density of sample_ward() at `to_light`; 0 where the light or the viewer is at or below the horizon. Walter's
// Eq. 9.
float ward_density(float alpha, vec3 normal, vec3 to_light, vec3 to_viewer) {
    if (min(dot(normal, to_light), dot(normal, to_viewer)) <= 0.0) return 0.0;
    const vec3 sum = to_light + to_viewer;
    const float along = dot(normal, sum);
    const vec3 across = sum - along * normal;
    const float tan2_h = dot(across, across) / (along * along);
    const float cos_h = inversesqrt(1.0 + tan2_h);
    const float alpha2 = alpha * alpha;
    // The half vector's angle to either direction has the cosine |sum| / 2.
    return exp(-tan2_h / alpha2) / (2.0 * kWardPi * alpha2 * cos_h * cos_h * cos_h * length(sum));
}

// The weight of a sample of density `own` where another technique would have drawn it with density `other` (Veach,
// 1997, the power heuristic with exponent 2); own > 0.
float power_heuristic(float own, float other) {
    const float ratio = other / own;
    return 1.0 / (1.0 + ratio * ratio);
}

#endif
