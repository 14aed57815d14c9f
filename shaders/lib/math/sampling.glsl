// Random directions and their densities, for light that is gathered by sampling. Functions without bindings. `u` are
// numbers in [0, 1); densities are per steradian.
#ifndef PATINA_LIB_SAMPLING_GLSL
#define PATINA_LIB_SAMPLING_GLSL

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

// The weight of a sample of density `own` where another technique would have drawn it with density `other` (Veach,
// 1997, the power heuristic with exponent 2); own > 0.
float power_heuristic(float own, float other) {
    const float ratio = other / own;
    return 1.0 / (1.0 + ratio * ratio);
}

#endif
