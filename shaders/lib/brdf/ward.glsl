// The isotropic Ward BRDF: all that shaders know of it. Functions without bindings. Directions are of unit length and
// lead away from the surface; alpha > 0.
#ifndef PATINA_LIB_BRDF_WARD_GLSL
#define PATINA_LIB_BRDF_WARD_GLSL
#include "lib/math/pi.glsl"
#include "lib/math/sampling.glsl"

// The half-angle form, for many lights and views of one surface point. The lobe times cos_i is
//   ward_scale(alpha) * ward_light_part(cos_i) * ward_viewer_part(cos_o) * ward_falloff(ward_shape(alpha),
//   ward_half_tan2(...)).

// 1 / (4 pi alpha^2), of the paper's Eq. 4.
float ward_scale(float alpha) { return 1.0 / (4.0 * kPi * alpha * alpha); }

// What the lobe times cos_i owes to one light alone, and to one view: cos_i / sqrt(cos_i cos_o) of the paper's Eq. 4
// and 6.
float ward_light_part(float cos_i) { return sqrt(cos_i); }
float ward_viewer_part(float cos_o) { return inversesqrt(cos_o); }

// tan^2 of the angle between normal and half vector, from the cosines of light and viewer to the normal and of the
// angle between both: with unit l and v, h = l + v has |h|^2 = 2 + 2 l.v, and tan^2 is |h|^2 / (n.h)^2 - 1. The error
// of this difference, 1e-6, is small beside alpha^2 of 1e-4.
float ward_half_tan2(float cos_i, float cos_o, float cos_between) {
    const float along = cos_i + cos_o;
    return max((2.0 + 2.0 * cos_between) / (along * along) - 1.0, 0.0);
}

// What of a lobe's shape does not depend on directions.
struct WardShape {
    float exponent_scale;  // of tan^2, in an exponent to the base of 2
    float log_peak;        // to the base of 2; 0: a peak of 1
};

const float kWardExponent = -1.442695;  // -log2(e)

WardShape ward_shape(float alpha) { return WardShape(kWardExponent / (alpha * alpha), 0.0); }

// The shape on a surface that bends: as wide as that of a rougher material, and with the same integral.
WardShape ward_shape_blurred(float alpha, float blur2) {
    const float inverse = 1.0 / (alpha * alpha + blur2);
    return WardShape(kWardExponent * inverse, log2(alpha * alpha * inverse));
}

// e^gamma of the paper's Eq. 3. It ends at 2^-60: its square is no denormal number yet, which processors take much
// longer for.
float ward_falloff(WardShape shape, float tan2) {
    const float exponent = tan2 * shape.exponent_scale + shape.log_peak;
    return exp2(max(exponent, -60.0));
}

// The Ward lobe without its albedo, e^gamma / N (paper, Eq. 3 and 4), in 1/sr. 0 where the light or the viewer is at or
// below the horizon, where N has no meaning.
float ward_lobe(float alpha, vec3 normal, vec3 to_light, vec3 to_viewer) {
    const float cos_i = dot(normal, to_light);
    const float cos_o = dot(normal, to_viewer);
    if (min(cos_i, cos_o) <= 0.0) return 0.0;
    // tan(theta_h) from the half vector's tangential part: 1 - cos^2 would cancel in sharp highlights.
    const vec3 half_vector = to_light + to_viewer;
    const float along = dot(normal, half_vector);
    const vec3 across = half_vector - along * normal;
    const float tan2_h = dot(across, across) / (along * along);
    const float alpha2 = alpha * alpha;
    return exp(-tan2_h / alpha2) / (4.0 * kPi * alpha2 * sqrt(cos_i * cos_o));
}

// The Ward BRDF (paper, Eq. 2), in 1/sr; kd and ks are RGB albedos. 0 where the light or the viewer is at or below the
// horizon.
vec3 ward(vec3 kd, vec3 ks, float alpha, vec3 normal, vec3 to_light, vec3 to_viewer) {
    if (min(dot(normal, to_light), dot(normal, to_viewer)) <= 0.0) return vec3(0.0);
    return kd / kPi + ks * ward_lobe(alpha, normal, to_light, to_viewer);
}

// What a point light adds to a pixel (one term of the paper's Eq. 6): BRDF * intensity / r^2 * cos(theta_i).
// `light_offset_m` leads from the surface point to the light; a light in the surface point itself adds nothing.
vec3 ward_point_light(vec3 kd, vec3 ks, float alpha, vec3 normal, vec3 light_offset_m, vec3 intensity, vec3 to_viewer) {
    const float distance2 = dot(light_offset_m, light_offset_m);
    if (distance2 <= 0.0) return vec3(0.0);
    const vec3 to_light = light_offset_m * inversesqrt(distance2);
    return ward(kd, ks, alpha, normal, to_light, to_viewer) * intensity * (max(dot(normal, to_light), 0.0) / distance2);
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
    return exp(-tan2_h / alpha2) / (2.0 * kPi * alpha2 * cos_h * cos_h * cos_h * length(sum));
}

#endif
